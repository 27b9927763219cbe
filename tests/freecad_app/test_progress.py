# SPDX-License-Identifier: LGPL-2.1-or-later
"""A long computation draws the window now and then, not at each of its steps, and stops soon after Escape."""

import pytest

from pkm_post.freecad_app import progress, window
from pkm_post.freecad_app.progress import Progress, Stopped


class Watch:
    """Says that Escape was pressed once the clock has come to a time."""

    def __init__(self, clock, escape_at):
        self.clock, self.escape_at, self.looks, self.texts = clock, escape_at, [], []

    def begin(self):
        pass

    def end(self):
        pass

    def pressed(self, text):
        self.looks.append(self.clock.now)
        self.texts.append(text)
        return self.clock.now >= self.escape_at


class Clock:
    now = 100.0

    def monotonic(self):
        return self.now


@pytest.fixture
def watch(monkeypatch):
    clock = Clock()
    made = Watch(clock, escape_at=103.0)
    monkeypatch.setattr(progress, "time", clock)
    monkeypatch.setattr(window, "ESCAPE_WATCHES", [lambda: made])
    return made


def test_quick_steps_draw_the_window_ten_times_a_second(watch):
    with Progress("Gouges", 2000) as bar:
        for _ in range(2000):
            bar.step()
            watch.clock.now += 0.001
    assert 19 <= len(watch.looks) <= 21
    assert watch.texts[0].startswith("Gouges: 0 %")


def test_each_slow_step_draws_the_window(watch):
    with Progress("Gouges", 5) as bar:
        for _ in range(5):
            bar.step()
            watch.clock.now += 0.2
    assert len(watch.looks) == 5


def test_escape_stops_it_within_a_tenth_of_a_second(watch):
    with pytest.raises(Stopped), Progress("Gouges", 9000) as bar:
        for _ in range(9000):
            bar.step()
            watch.clock.now += 0.001
    assert watch.clock.now <= 103.11
