"""The bytes between host and robot, as include/rift/hardware/wire.hpp describes them.

Runs on the robot (MicroPython) and nowhere needs its hardware.
"""

import struct

START = 0xA5
COMMAND_SIZE = 11
ANSWER_START = 0x5A
FULL = 1000


def crc8(data):
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = ((crc << 1) ^ 0x07) & 0xFF if crc & 0x80 else crc << 1
    return crc


def decode_command(data):
    """(sequence, left, right) of a frame in 1/1000, or None unless every check holds."""
    if data[0] != START or crc8(data[:-1]) != data[-1]:
        return None
    _, sequence, left, right, not_left, not_right, _ = struct.unpack("<BBhhhhB", data)
    if not_left != ~left or not_right != ~right or abs(left) > FULL or abs(right) > FULL:
        return None
    return sequence, left, right


def _milli(text, at):
    """(power in 1/1000, next index) of exactly "-0.85" or "0.85" at `at`, or None."""
    negative = text[at : at + 1] == b"-"
    if negative:
        at += 1
    part = text[at : at + 4]
    if len(part) != 4 or part[1] != 0x2E:
        return None
    value = 0
    for i in (0, 2, 3):
        if not 0x30 <= part[i] <= 0x39:
            return None
        value = 10 * value + part[i] - 0x30
    if value > 100:
        return None
    return (-10 * value if negative else 10 * value), at + 4


def parse_plain_line(text):
    """(left, right) in 1/1000 of a line without its newline, or None.

    Exactly two decimals: a lost byte turns 0.85 into 85, 0.8 or 0.850.90.
    """
    left = _milli(text, 0)
    if left is None or text[left[1] : left[1] + 1] != b" ":
        return None
    right = _milli(text, left[1] + 1)
    if right is None or right[1] != len(text):
        return None
    return left[0], right[0]


def answer_frame(sequence, stops, left, right, battery_mv, rejected):
    data = struct.pack(
        "<BBBiiHB", ANSWER_START, sequence, stops, left, right, battery_mv, rejected
    )
    return data + bytes((crc8(data),))


def answer_line(left, right, battery_mv):
    text = "rift1 %d %d %d" % (left, right, battery_mv)
    return ("%s*%02x\n" % (text, crc8(text.encode()))).encode()
