# SPDX-License-Identifier: LGPL-2.1-or-later
"""Certificate log: the worst of each quantity of all motions that were played, with time and place.

Enters: certificates of motions, in the order in which they were played. Leaves: findings as those of one certificate.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from pkm_post.model import Certificate, Finding


@dataclass
class CertificateLog:
    """What was played.

    Attributes:
        seconds: of motion.
        motions: number of certificates.
    """

    seconds: float = 0.0
    motions: int = 0
    _worst: dict[tuple[str, str], Finding] = field(default_factory=dict)

    def add(self, certificate: Certificate) -> None:
        """Add the next motion."""
        for finding in certificate.findings:
            key, before = (finding.code, finding.name), self._worst.get((finding.code, finding.name))
            if before is None or _use(finding) > _use(before):
                self._worst[key] = replace(finding, time=finding.time + self.seconds)
        self.seconds += certificate.duration
        self.motions += 1

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The worst of each quantity."""
        return tuple(self._worst.values())

    @property
    def holds(self) -> bool:
        """Whether everything holds."""
        return all(finding.holds for finding in self.findings)


def _use(finding: Finding) -> float:
    """A value by its limit; a limit of 0 is a bound of a difference."""
    return finding.value / finding.limit if finding.limit else finding.value
