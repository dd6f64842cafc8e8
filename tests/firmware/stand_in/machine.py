"""In place of MicroPython's machine: a serial line that says what a script tells it to."""

import bench


class Pin:
    def __init__(self, number):
        self.number = number


class UART:
    def __init__(self, number, baudrate, tx, rx, rxbuf):
        assert bench.speeds == (0, 0)  # the motors stand before anything is heard
        bench.uart = (number, baudrate, tx.number, rx.number, rxbuf)
        self._data = b""

    def any(self):
        self._data += bench.next_chunk()
        return len(self._data)

    def read(self, count):
        data = self._data[:count]
        self._data = self._data[count:]
        return data

    def write(self, data):
        bench.said += bytes(data)
