# SPDX-License-Identifier: LGPL-2.1-or-later
"""Answers byte by byte. The transcripts are those of the manuals: handshake and checksums [TurboPMAC, I3, I4, I6]."""

import random
from collections import Counter

import pytest

from pkm_post.control.link.protocol import Answer, Lost, Refusal
from pkm_post.control.link.serial_protocol import ResponseParser, checksum


def read(transcript, command=b"", summed=False):
    """The event and how many bytes it took."""
    reader = ResponseParser(command, summed)
    for count, byte in enumerate(bytes.fromhex(transcript), start=1):
        event = reader.take(byte)
        if event is not None:
            return event, count, [message.text for message in reader.messages]
    return None, len(bytes.fromhex(transcript)), [message.text for message in reader.messages]


def test_no_data():
    assert read("06") == (Answer(()), 1, [])


def test_data():
    assert read("32 35 0D 35 30 0D 06") == (Answer(("25", "50")), 7, [])


def test_data_with_checksums():
    # P1..3 with I3=2, I4=1: 25, 50, 75; the sum of "P1..3" is 110 hexadecimal, so the last byte is 10
    assert checksum(b"P1..3") == 0x10
    event, _, _ = read("32 35 0D 74 35 30 0D 72 37 35 0D 79 06 10", b"P1..3", summed=True)
    assert event == Answer(("25", "50", "75"))


def test_checksums_that_look_like_the_end():
    # 0x06, 0x07 and 0x0D stand where a checksum is due: the lines are chosen so that they sum to that
    for wanted in (0x06, 0x07, 0x0D, 0x02):
        letters = ((a, b, c) for a in range(0x41, 0x5B) for b in range(0x30, 0x3A) for c in range(0x30, 0x7F))
        text = next(bytes([*three, 13]) for three in letters if (sum(three) + 13) & 0xFF == wanted)
        event, _, _ = read((text + bytes([wanted])).hex() + "06 10", b"P1..3", summed=True)
        assert event == Answer((text[:-1].decode(),))


@pytest.mark.parametrize(
    "transcript", ["07 45 52 52 30 30 33 0D", "07 0D 45 52 52 30 30 33 0D", "07 0A 45525230 30330D"]
)
def test_a_refusal(transcript):
    assert read(transcript)[0] == Refusal(3)


def test_a_refusal_behind_data():
    assert read("32 35 0D 07 45 52 52 30 31 35 0D")[0] == Refusal(15)


def test_what_programs_say_is_put_aside():
    assert read("02 48 45 59 0D 32 35 0D 02 59 0D 06") == (Answer(("25",)), 12, ["HEY", "Y"])


@pytest.mark.parametrize(
    "transcript",
    [
        "32 35 0D 75",
        "32 06",
        "32 07",
        "32 80",
        "07 45 52 52 0D",
        "07 45 52 52 30 30 33 30 30 33 30 30 33 30 30 33 30",
        "06 11",
    ],
)
def test_no_sense_is_reported(transcript):
    assert isinstance(read(transcript, b"P1..3", summed=True)[0], Lost)


def test_one_changed_bit_is_never_an_answer_of_other_data():
    good = bytes.fromhex("32 35 0D 74 35 30 0D 72 37 35 0D 79 06 10")
    for place in range(len(good)):
        for bit in range(8):
            changed = bytes([*good[:place], good[place] ^ 1 << bit, *good[place + 1 :]])
            event, _, _ = read(changed.hex(), b"P1..3", summed=True)
            assert not isinstance(event, Answer), (place, bit)


def test_any_bytes_are_taken():
    chance = random.Random(5)
    ends = Counter()
    for _ in range(2000):
        event, count, _ = read(chance.randbytes(40).hex(), b"P1", summed=chance.random() < 0.5)
        ends[type(event)] += 1
        assert count <= 40 and (event is not None or count == 40)
    assert ends[Lost] > 1500 and set(ends) <= {Lost, Answer, Refusal, type(None)}
