# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certificate log: the worst of each quantity over all played motions, with time and place.

The certificates of single motions hold for the whole, except for the blocks in a second, which are counted across the
ends of motions. They hold for a time base of at most 100 %, and no longer once it exceeded that.

Input: motions with their certificates, in order of play. Output: findings as in one certificate.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pkm_post.control.link.run import HIGHEST_OVERRIDE
from pkm_post.control.player.certified_motion import CertifiedMotion
from pkm_post.geometry import Array
from pkm_post.model import Finding

_BLOCKS = "V117"
_SECOND_MS = 1000


class CertificateLog:
    """The log of a play.

    Attributes:
        motions: number of motions.
        override: highest override of the controller meanwhile, %.
    """

    def __init__(self) -> None:
        self.motions, self.override = 0, 0.0
        self._ms = 0
        self._recent: Array = np.zeros(1, dtype=np.int64)
        self._worst: dict[tuple[str, str], Finding] = {}

    @property
    def seconds(self) -> float:
        """Duration of the motions."""
        return self._ms / 1000

    def add(self, motion: CertifiedMotion) -> None:
        """Add the next motion."""
        blocks = self._blocks(motion)
        for finding in motion.certificate.findings:
            if finding.code == _BLOCKS:
                value = float(max(blocks, finding.value))
                finding = replace(finding, value=value, holds=value <= finding.limit)
            key = finding.code, finding.name
            before = self._worst.get(key)
            if before is None or _use(finding) > _use(before):
                self._worst[key] = replace(finding, time=finding.time + self.seconds)
        self._ms += int(motion.struts.time_ms[-1])
        self.motions += 1

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The worst of each quantity."""
        return tuple(self._worst.values())

    @property
    def holds(self) -> bool:
        """Whether all findings hold, at the overrides that the controller had."""
        return self.override <= HIGHEST_OVERRIDE and all(finding.holds for finding in self.findings)

    def _blocks(self, motion: CertifiedMotion) -> int:
        """Most points in any second up to the end of a motion."""
        times = np.concatenate([self._recent, self._ms + motion.struts.time_ms[1:]])
        count = np.searchsorted(times, times + _SECOND_MS) - np.arange(len(times))
        self._recent = times[times > times[-1] - _SECOND_MS]
        return int(count.max())


def _use(finding: Finding) -> float:
    """Measure of how bad a value is: its share of the limit, or the value itself if the limit is 0."""
    if finding.is_least:
        return -finding.value
    return finding.value / finding.limit if finding.limit else finding.value
