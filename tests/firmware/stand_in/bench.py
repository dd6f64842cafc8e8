"""The script: one line for each turn of the robot's loop, "TIME_MS HEX" or "TIME_MS !", which breaks
the serial line. After each turn the trace tells what came of it."""

speeds = None
motors_off = 0
motors_told = 0
counts = (0, 0)
battery_mv = 5000
screen = []
said = b""
now_ms = 0
uart = None
turns = []
trace = []
_turn = -1
_data = b""


class Over(BaseException):
    """Ends the loop of main.py as unplugging would."""


def load(script):
    global turns
    turns = [line.split(" ") for line in script.split("\n") if line]


def _note():
    global said
    trace.append("%d %d %s" % (speeds[0], speeds[1], said.hex() or "-"))
    said = b""


def start_turn():
    global _turn, _data, now_ms, counts, battery_mv
    if _turn >= 0:
        _note()
    _turn += 1
    if _turn == len(turns):
        raise Over()
    now_ms = int(turns[_turn][0])
    counts = (3 * _turn, -5 * _turn)
    battery_mv = 4000 + _turn % 1000
    _data = turns[_turn][1]


def next_chunk():
    global _data
    data = _data
    _data = "-"
    if data == "!":
        raise OSError("the serial line broke, and nobody knows why")
    return b"" if data == "-" else bytes.fromhex(data)
