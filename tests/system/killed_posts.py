# SPDX-License-Identifier: LGPL-2.1-or-later
"""Processes that post into one folder and are killed while they move their files; what a reader finds afterwards.

    killed_posts.py FOLDER KILLS    kills at every step of posting once, then so many at random instants, most of them
                                    while files are moved; prints how often a reader found what, as JSON
    killed_posts.py FOLDER post TEXT TIMES    posts so often, to be run by several processes

The last results of all are whole, and nothing else is in the folder. Anything else ends with an ``AssertionError``.
"""

import json
import os
import random
import signal
import sys
import time
from collections import Counter
from itertools import count
from pathlib import Path

from pkm_post.system import staged
from pkm_post.writing import manifest

NAMES = ("part.pmc", "part-part2.pmc", "part-setup.pmc", "part.pkmt", "part-report.json")
MANIFEST = manifest.manifest_name("part")
AIMED_AT = ("os.rename", "os.remove", "os.rmdir", "os.mkdir", "open", "fcntl.flock", "os.listdir", "shutil.rmtree")
"""What Python says before it calls the system, as far as posting does it."""
LONGEST_MOVE = 2e-4
"""s: within this a process is killed after one of its moves has begun."""
RARELY = 10
"""Every so many processes one is killed at any instant, moving files or not."""


def written(text, name):
    """The bytes of a result."""
    return f"{text} {name}\n".encode()


def post(folder, text):
    """What posting does with its files, in a folder that it may not have to itself."""
    with staged(folder, MANIFEST) as private:
        for name in NAMES:
            (private / name).write_bytes(written(text, name))
        manifest.write(private, "part")


def whole(folder):
    """The text of the results that a reader accepts, whichever of them it is asked for; None where it refuses."""
    accepted = {name for name in NAMES if manifest.check(folder / name)[0]}
    assert accepted in (set(), set(NAMES)), f"only {accepted} would be read"
    return texts_in(folder)[0] if accepted else None


def texts_in(folder):
    """The texts of all results that are there, which must be one or none."""
    there = [folder / name for name in NAMES if (folder / name).exists()]
    texts = {file.read_text().split()[0] for file in there}
    assert len(texts) <= 1, f"results of {texts} stand beside each other"
    return sorted(texts)


def seen(folder, before):
    """What a reader finds after a process was killed that posted over ``before``."""
    text = whole(folder)
    texts = texts_in(folder)
    if text is None:
        return "refused, earlier ones" if texts == [before] else "refused, new ones" if texts else "refused, none"
    return "earlier ones" if text == before else "new ones"


def killed(work):
    """Let a child do some work until it is killed, or to its end; whether it was killed."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            work()
            code = 0
        finally:
            os._exit(code)
    _, status = os.waitpid(child, 0)
    assert os.WIFSIGNALED(status) or os.waitstatus_to_exitcode(status) == 0
    return os.WIFSIGNALED(status)


def post_until_step(folder, text, last):
    """Post, and be killed before the system is called for the ``last`` time."""
    steps = count()

    def hook(event, arguments):
        if event in AIMED_AT and next(steps) == last:
            os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(hook)
    post(folder, text)


def at_every_step(folder):
    """Kill at each call of the system once."""
    found = Counter()
    for step in count():
        post(folder, "before")
        if not killed(lambda step=step: post_until_step(folder, "after", step)):
            return found
        found[seen(folder, "before")] += 1


def post_and_say_when(folder, text, move, pipe):
    """Post, and write a byte when a move begins, or at once."""
    moves = count()

    def hook(event, arguments):
        if event == "os.rename" and next(moves) == move:
            os.write(pipe, b"!")

    sys.addaudithook(hook)
    if move is None:
        os.write(pipe, b"!")
    post(folder, text)
    time.sleep(60)  # the kill may come late


def at_random(folder, kills, chance):
    """Kill at random instants."""
    found = Counter()
    for number in range(kills):
        post(folder, "before")
        reader, writer = os.pipe()
        move = None if number % RARELY == 0 else chance.randrange(2 * len(NAMES) + 2)
        child = os.fork()
        if child == 0:
            try:
                post_and_say_when(folder, "after", move, writer)
            finally:
                os._exit(1)
        os.close(writer)
        assert os.read(reader, 1) == b"!"
        time.sleep(chance.random() * LONGEST_MOVE)
        os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
        assert os.WIFSIGNALED(status)
        os.close(reader)
        found[seen(folder, "before")] += 1
    return found


def main(folder, *words):
    if words[0] == "post":
        for _ in range(int(words[2])):
            post(folder, words[1])
        return
    found = {"at every step": at_every_step(folder), "at random": at_random(folder, int(words[0]), random.Random(1))}
    post(folder, "last")
    assert whole(folder) == "last"
    assert sorted(os.listdir(folder)) == sorted([*NAMES, MANIFEST])
    print(json.dumps(found))


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
