# SPDX-License-Identifier: LGPL-2.1-or-later
"""How fast the kinematics are on one core: this code next to C that does the same, in one run.

    python3 benchmarks/kinematics.py [--poses 200000] [--path 1000000] [--many 10000000]

Enters: nothing but numbers of poses. Leaves: poses per second of each step, in processor time of one thread; for
inverse, forward and Jacobian next to a loop in C over the same formulas, compiled for the run where there is a
compiler (cc -O2, no vector options), and their ratio; the time of all checks on a path; and by how much memory grows
with the number of poses. Results of both are compared before anything is timed. Nothing is asserted about times.
"""

import argparse
import ctypes
import os
import shutil
import subprocess
import sys
import tempfile
import time
import tracemalloc
from pathlib import Path

os.environ.update(dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import numpy as np  # noqa: E402 - the threads are chosen first

from pkm_post.machine import (  # noqa: E402 - the path comes first
    CollisionMesh,  # noqa: E402 - the path comes first
    PosePath,  # noqa: E402 - the path comes first
    find_machine,  # noqa: E402
    forward,  # noqa: E402 - the path comes first
    jacobian_of_tip,
    reach_findings,  # noqa: E402 - the path comes first
    scaled_jacobian,
    strut_lengths,  # noqa: E402 - the path comes first
)
from pkm_post.machine.description.reader import read_machine  # noqa: E402
from pkm_post.machine.reach.limit_checks import smallest_singular_value  # noqa: E402

REPEATS = 7
"""Runs of each step; the fastest counts, as the others were disturbed."""

C_CODE = r"""
#include <math.h>
#include <string.h>
static void rotation(const double *k, double psi, double R[9]) {
    double lean = 1 + k[2], c = cos(psi), s = sin(psi);
    double x[3] = {1 - k[0] * k[0] / lean, -k[0] * k[1] / lean, -k[0]};
    double y[3] = {-k[0] * k[1] / lean, 1 - k[1] * k[1] / lean, -k[1]};
    for (int i = 0; i < 3; i++) {
        R[3 * i] = c * x[i] + s * y[i]; R[3 * i + 1] = c * y[i] - s * x[i]; R[3 * i + 2] = k[i];
    }
}
/* lengths and, if asked for, the rows [u, r x u] of the tip's Jacobian */
static void linearise(const double *q, const double R[9], double reach, const double *a, const double *b,
                      double *length, double J[36]) {
    for (int i = 0; i < 6; i++) {
        double r[3], u[3], square = 0;
        for (int j = 0; j < 3; j++) {
            r[j] = R[3 * j] * a[3 * i] + R[3 * j + 1] * a[3 * i + 1] + R[3 * j + 2] * (a[3 * i + 2] + reach);
            u[j] = q[j] + r[j] - b[3 * i + j]; square += u[j] * u[j];
        }
        length[i] = sqrt(square);
        if (!J) continue;
        for (int j = 0; j < 3; j++) J[6 * i + j] = u[j] /= length[i];
        J[6 * i + 3] = r[1] * u[2] - r[2] * u[1]; J[6 * i + 4] = r[2] * u[0] - r[0] * u[2];
        J[6 * i + 5] = r[0] * u[1] - r[1] * u[0];
    }
}
void inverse(long n, const double *q, const double *k, const double *psi, const double *reach,
             const double *a, const double *b, double *length) {
    double R[9];
    for (long i = 0; i < n; i++) {
        rotation(k + 3 * i, psi[i], R); linearise(q + 3 * i, R, reach[i], a, b, length + 6 * i, 0);
    }
}
void jacobian(long n, const double *q, const double *k, const double *psi, const double *reach,
              const double *a, const double *b, double *J) {
    double R[9], length[6];
    for (long i = 0; i < n; i++) {
        rotation(k + 3 * i, psi[i], R); linearise(q + 3 * i, R, reach[i], a, b, length, J + 36 * i);
    }
}
static void solve(double A[36], double x[6]) {
    for (int p = 0; p < 6; p++) {
        int best = p;
        for (int i = p + 1; i < 6; i++) if (fabs(A[6 * i + p]) > fabs(A[6 * best + p])) best = i;
        for (int j = 0; j < 6; j++) { double t = A[6 * p + j]; A[6 * p + j] = A[6 * best + j]; A[6 * best + j] = t; }
        double t = x[p]; x[p] = x[best]; x[best] = t;
        for (int i = p + 1; i < 6; i++) {
            double f = A[6 * i + p] / A[6 * p + p];
            for (int j = p; j < 6; j++) A[6 * i + j] -= f * A[6 * p + j];
            x[i] -= f * x[p];
        }
    }
    for (int p = 5; p >= 0; p--) {
        for (int j = p + 1; j < 6; j++) x[p] -= A[6 * p + j] * x[j];
        x[p] /= A[6 * p + p];
    }
}
static void turn(double R[9], const double *w) {
    double angle = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]), s = angle > 0 ? sin(angle) / angle : 1;
    double h = angle > 0 ? (1 - cos(angle)) / (angle * angle) : 0.5, old[9];
    double K[9] = {0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0}, E[9];
    for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) {
        double square = 0;
        for (int m = 0; m < 3; m++) square += K[3 * i + m] * K[3 * m + j];
        E[3 * i + j] = (i == j) + s * K[3 * i + j] + h * square;
    }
    memcpy(old, R, sizeof old);
    for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) {
        R[3 * i + j] = 0;
        for (int m = 0; m < 3; m++) R[3 * i + j] += E[3 * i + m] * old[3 * m + j];
    }
}
void forward(long n, const double *wanted, double *q, const double *k, const double *psi, const double *reach,
             const double *a, const double *b) {
    double R[9], J[36], length[6], x[6];
    for (long i = 0; i < n; i++) {
        rotation(k + 3 * i, psi[i], R);
        for (int step = 0; step < 20; step++) {
            double worst = 0;
            linearise(q + 3 * i, R, reach[i], a, b, length, J);
            for (int j = 0; j < 6; j++) {
                x[j] = wanted[6 * i + j] - length[j]; if (fabs(x[j]) > worst) worst = fabs(x[j]);
            }
            if (worst < 1e-10) break;
            solve(J, x);
            for (int j = 0; j < 3; j++) q[3 * i + j] += x[j];
            turn(R, x + 3);
        }
    }
}
"""


def compiled(folder):
    """The C code as a library, or None without a compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        return None
    source, library = Path(folder, "kinematics.c"), Path(folder, "kinematics.so")
    source.write_text(C_CODE)
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
    return ctypes.CDLL(str(library))


def call(function, count, *arrays):
    """Call a C function with the number of poses and its arrays."""
    function(ctypes.c_long(count), *(ctypes.c_void_p(array.ctypes.data) for array in arrays))


def seconds(action, repeats=REPEATS):
    """The least processor time of an action, in s."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return min(times)


def poses(count, tilt_deg=15.0):
    """Poses inside the example machine: tip, axis, spin, gauge length."""
    rng = np.random.default_rng(1)
    tip = rng.uniform([-80, -80, 180], [80, 80, 320], (count, 3))
    tilt, azimuth = np.radians(tilt_deg) * rng.random(count), rng.uniform(0, 2 * np.pi, count)
    axis = np.column_stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])
    return tip, axis, rng.uniform(-0.3, 0.3, count), np.full(count, 120.0)


def steps(machine, library, count):
    """For each step its name, this code, and the same in C or None."""
    pose = poses(count)
    tip, axis, spin, length = pose
    reach = machine.spindle_nose + length
    joints = np.array(machine.platform_joints), np.array(machine.base_joints)
    lengths, jacobian = strut_lengths(machine, *pose), scaled_jacobian(machine, *pose)
    off = tip + np.random.default_rng(2).normal(size=tip.shape) * 3, axis, spin + np.radians(2.0)
    limit = machine.least_singular_value

    def in_c(name, result, *before):
        if library is None:
            return None

        def run():
            for array, start in before:
                np.copyto(array, start)
            call(getattr(library, name), count, *result)

        return run

    c_lengths, c_jacobian, c_tip = np.empty((count, 6)), np.empty((count, 6, 6)), off[0].copy()
    loops = {
        "inverse": in_c("inverse", (tip, axis, spin, reach, *joints, c_lengths)),
        "jacobian": in_c("jacobian", (tip, axis, spin, reach, *joints, c_jacobian)),
        "forward": in_c("forward", (lengths, c_tip, axis, off[2], reach, *joints), (c_tip, off[0])),
    }
    if library is not None:
        for loop in loops.values():
            loop()
        found = forward(machine, lengths, length, *off)
        print("differences from C: "
              f"inverse {np.abs(c_lengths - lengths).max():.1e} mm, "
              f"Jacobian {np.abs(c_jacobian - jacobian_of_tip(machine, *pose)).max():.1e}, "
              f"forward {np.abs(c_tip - found.tip).max():.1e} mm, all converged: {found.converged.all()}")  # fmt: skip
    return (
        ("inverse", lambda: strut_lengths(machine, *pose), loops["inverse"]),
        ("forward, 5 mm and 2 degrees off", lambda: forward(machine, lengths, length, *off), loops["forward"]),
        ("Jacobian of the tip", lambda: jacobian_of_tip(machine, *pose), loops["jacobian"]),
        ("conditioning, screened", lambda: smallest_singular_value(jacobian, np.linalg.det(jacobian), limit), None),
        ("conditioning, all decomposed", lambda: np.linalg.svd(jacobian, compute_uv=False), None),
    )


def path(count):
    """Laps around a cone, a tenth of a millimetre from pose to pose, and the time of each step at 100 mm/s."""
    turn = np.arange(count) * 0.1 / 60
    tilt = np.radians(15) + np.radians(4) * np.sin(7 * turn)
    tip = np.column_stack([60 * np.cos(turn), 60 * np.sin(turn), 200 + 30 * np.sin(turn / 50)])
    axis = np.column_stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    return PosePath.straight(tip, axis, np.zeros(count), np.full(count, 120.0)), np.full(count, 1e-3)


def cone():
    """A round part inside the path, as 4,800 triangles."""
    turn, high = np.meshgrid(np.linspace(0, 2 * np.pi, 61), np.linspace(0, 1, 41))
    radius = 55 - 25 * high
    p = np.stack([radius * np.cos(turn), radius * np.sin(turn), 60 + 200 * high], axis=-1)
    halves = [[p[:-1, :-1], p[1:, :-1], p[:-1, 1:]], [p[1:, 1:], p[1:, :-1], p[:-1, 1:]]]
    return CollisionMesh.of(np.concatenate([np.stack(half, axis=-2).reshape(-1, 3, 3) for half in halves]))


def checks(machine, count):
    """Time and print all checks on a path."""
    (way, duration), part = path(count), cone()
    normal = np.tile([0.0, 0.0, 1.0], (count, 1))
    start = time.process_time()
    findings = reach_findings(machine, way, part, duration, normal)
    spent = time.process_time() - start
    print(f"\nall {len(findings)} checks on a path of {count:,} poses: {spent:.1f} s, {count / spent:,.0f} poses/s")
    for finding in findings:
        print(f"  {finding.subject.name:28} least margin {finding.margin.min():10.4g} {finding.subject.unit}")


def memory(machine, count):
    """Print what the inverse needs beside its arguments and its result, for few and for many poses."""
    print("\nmemory of the inverse beside arguments and result:")
    few = poses(100_000)
    for total in (100_000, count):
        pose = tuple(np.resize(column, (total, *column.shape[1:])) for column in few)
        tracemalloc.start()
        lengths = strut_lengths(machine, *pose)
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        print(f"  {total:>12,} poses  {(peak - lengths.nbytes) / 1e6:8.2f} MB")


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=200_000)
    parser.add_argument("--path", type=int, default=1_000_000)
    parser.add_argument("--many", type=int, default=10_000_000)
    chosen = parser.parse_args()
    machine, diagnostics = read_machine(find_machine("example_6tps"))
    if machine is None:
        raise SystemExit("\n".join(map(str, diagnostics)))
    with tempfile.TemporaryDirectory() as folder:
        library = compiled(folder)
        if library is None:
            print("no C compiler: the columns for C stay empty")
        table = steps(machine, library, chosen.poses)
        print(f"{'step':34} {'poses/s':>12} {'C, poses/s':>12} {'ratio':>7}")
        for name, ours, loop in table:
            rate = chosen.poses / seconds(ours)
            print(f"{name:34} {rate:12,.0f}", end="")
            if loop is not None:
                rate_in_c = chosen.poses / seconds(loop)
                print(f" {rate_in_c:12,.0f} {rate / rate_in_c:7.2f}", end="")
            print()
    checks(machine, chosen.path)
    memory(machine, chosen.many)


if __name__ == "__main__":
    main()
