# SPDX-License-Identifier: LGPL-2.1-or-later
"""Packets. The bytes are those of the UMAC Turbo CPU manual, chapter Ethernet Protocol, and of clients of others."""

import random
import struct

import pytest

from pkm_post.control.simulator import Controller, EthernetPort, SerialPort


def packet(kind, request, data=b"", value=0, length=None):
    return struct.pack(">BBHHH", kind, request, value, 0, len(data) if length is None else length) + data


def get_response(text):
    return packet(0x40, 0xBF, text.encode())


GET_BUFFER = packet(0xC0, 0xC5, length=1400)
GET_LINE = packet(0xC0, 0xB1, length=255)
READY = packet(0xC0, 0xC2, length=2)
FLUSH = packet(0x40, 0xB3)


@pytest.fixture
def link():
    packets = EthernetPort(SerialPort(Controller()))
    packets.receive(get_response("I3=2 I6=1"))
    return packets


def test_get_response(link):
    assert bytes.fromhex("40BF000000000003") + b"ver" == get_response("ver")
    assert link.receive(get_response("ver")) == b"1.947\r\x06"
    assert link.receive(get_response("ver\r")) == b"1.947\r\x06"
    assert link.receive(get_response("FOO")) == b"\x07ERR003\r"
    assert link.receive(get_response("X1")) == b"\x07ERR005\r"
    assert link.receive(get_response("P1=\x80")) == b"\x07ERR004\r"


def test_a_long_answer_is_fetched_in_pieces_of_1400_bytes(link):
    link.receive(get_response("P0..999=1.5"))
    answer = link.receive(get_response("P0..999"))
    assert len(answer) == 1400
    for _ in range(2):
        answer += link.receive(GET_BUFFER)
    assert answer == b"1.5\r" * 1000 + b"\x06"
    assert link.receive(GET_BUFFER) == b"\0"


def test_lines_are_sent_and_fetched_one_by_one(link):
    assert link.receive(READY) == b"\0\0"
    assert link.receive(GET_LINE) == b"\0"
    assert link.receive(packet(0x40, 0xB0, b"P1..2")) == b"\x40"
    assert link.receive(READY) == b"\1\0"
    assert [link.receive(GET_LINE) for _ in range(4)] == [b"0\r", b"0\r", b"\x06", b"\0"]


def test_flushing_forgets_what_waits(link):
    link.receive(packet(0x40, 0xB0, b"P1..2"))
    assert link.receive(FLUSH) == b"\x40"
    assert link.receive(READY) == b"\0\0"


def test_control_characters(link):
    def ask(code):
        return link.receive(packet(0xC0, 0xC4, value=code, length=1400))

    assert ask(0x10) == b"0 0 0 0 0 0 0 0\r\x06"
    assert ask(0x07) == b"0" * 12 + b"\r\x06"
    assert ask(0x01) == b""
    assert not int(link.receive(get_response("#1?"))[:6], 16) & 1 << 18, "abort closes open loops"


def test_write_buffer_takes_many_lines(link):
    lines = [b"OPEN PROG 10", b"CLEAR", b"LINEAR", b"X10 Y20", b"CLOSE"]
    assert link.receive(packet(0x40, 0xC6, b"\0".join(lines) + b"\0")) == bytes(4)
    assert link.receive(get_response("LIST PROG 10")) == b"LIN\rX10Y20\rRET\r\x06"


def test_write_buffer_tells_line_and_number_of_the_first_error(link):
    lines = [b"P1=1", b"P2=2", b"FOO", b"P3=3"]
    assert link.receive(packet(0x40, 0xC6, b"\0".join(lines))) == bytes([3, 0, 3, 0x80])
    assert link.receive(get_response("P1..3")) == b"1\r2\r0\r\x06"


def test_packets_are_answered_in_whatever_pieces_they_come(link):
    stream = get_response("P1=4") + get_response("P1") + READY + FLUSH + get_response("FOO")
    expected = b"\x06" + b"4\r\x06" + b"\0\0" + b"\x40" + b"\x07ERR003\r"
    assert link.receive(stream) == expected
    chance = random.Random(3)
    for _ in range(20):
        answer, at = b"", 0
        while at < len(stream):
            size = chance.randint(1, 11)
            answer += link.receive(stream[at : at + size])
            at += size
        assert answer == expected


def test_unknown_requests_are_passed_over_with_their_data(link):
    assert link.receive(packet(0x40, 0xE0, b"1234") + packet(0xC0, 0xB4, length=8) + get_response("P1")) == b"0\r\x06"


def test_what_is_no_packet_is_passed_over(link):
    assert link.receive(b"GET / HTTP/1.1\r\n\r\n") == b""
    assert link.receive(get_response("P1")) == b"0\r\x06"
    assert link.receive(packet(0x40, 0xBF, b"x" * 8, length=1493)) == b""
    assert link.receive(get_response("P1")) == b"0\r\x06"


def test_the_port_stays_what_it_is_when_a_connection_ends():
    # A buffer that one connection left open is closed by the next: to the controller there is one Ethernet port.
    line = SerialPort(Controller())
    EthernetPort(line).receive(get_response("I3=2 I6=1 OPEN PROG 10"))
    after = EthernetPort(line)
    assert after.receive(get_response("X1")) == b"\x06"
    assert after.receive(get_response("CLOSE")) == b"\x06"
    assert after.receive(get_response("LIST PROG 10")) == b"X1\rRET\r\x06"
