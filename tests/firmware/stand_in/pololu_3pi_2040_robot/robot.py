"""In place of Pololu's library, with the calls that its 3pi+ 2040 manual documents."""

import bench


class Motors:
    MAX_SPEED = 6000

    def set_speeds(self, left, right):
        assert abs(left) <= self.MAX_SPEED and abs(right) <= self.MAX_SPEED
        bench.speeds = (left, right)
        bench.motors_told += 1

    def off(self):
        bench.speeds = (0, 0)
        bench.motors_off += 1


class Encoders:
    def get_counts(self, reset=False):
        return list(bench.counts)


class Battery:
    def get_level_millivolts(self):
        return bench.battery_mv


class Display:
    def __init__(self):
        self._lines = []

    def fill(self, color):
        assert color == 0  # dark, and letters are light
        self._lines = []

    def text(self, text, x, y, color=1):
        # Letters are 8 px high, and five lines have 64 px.
        assert (x, y, color) == (0, 12 * len(self._lines), 1)
        self._lines.append(text)

    def show(self):
        bench.screen = self._lines
