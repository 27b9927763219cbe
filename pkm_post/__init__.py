# SPDX-License-Identifier: LGPL-2.1-or-later
"""PKM Post: from CAM jobs to certified motion programs of 6-TPS parallel kinematic machine tools."""

__version__ = "0.1.0"


def post_job(job, machine="example_6tps", out=".", **choices):  # type: ignore[no-untyped-def]
    """Post a CAM job from a macro: the same as ``pkm_post.freecad_app.post_job.post_job``.

    Args:
        job: the CAM job, a document object.
        machine: name of a machine that comes with PKM Post, or path of a machine file.
        out: folder for the results.
        choices: options, tool_lengths and log of that function.
    """
    from pkm_post.freecad_app.post_job import post_job as post

    return post(job, machine, out, **choices)
