"""What the robot does with the bytes it hears; include/rift/hardware/listener.hpp is its twin.

Starts at zero, obeys a command or rejects it (never makes it fit), and stops by itself when no
command comes for WATCHDOG_MS.
"""

import rift_protocol as protocol

WATCHDOG_MS = 300
PLAIN_ANSWER_MS = 200
LONGEST_LINE = 11  # "-0.85 -0.90"
WINDOW = 127
TICKS = 0x3FFFFFFF  # time.ticks_ms wraps around here

NEWLINE = 0x0A


class Listener:
    def __init__(self):
        self.motors = (0, 0)  # in 1/1000 of full power
        self.stops = 0
        self.rejected = 0
        self.framed = False  # the last command obeyed was a frame
        self.fed = False  # a command was obeyed, and the robot has not stopped by itself since
        self._ready = False  # a zero frame came since the robot stopped by itself
        self._sequence = 0
        self._now = 0
        self._fed_at = 0
        self._answered_at = None
        self._pending = None
        self._buffer = bytearray()
        self._line = bytearray()
        self._skipping = False

    def poll(self, now_ms, data, senses):
        """One turn with all bytes since the last; `senses()` gives encoder counts and millivolts.

        Returns the bytes to send back.
        """
        self._now = now_ms
        if self.fed and (now_ms - self._fed_at) & TICKS >= WATCHDOG_MS:
            self._stop_by_itself()
        for byte in data:
            self._buffer.append(byte)
            self._scan()
        return self._answer(senses)

    def _scan(self):
        while self._buffer:
            if self._buffer[0] == protocol.START:
                if len(self._buffer) < protocol.COMMAND_SIZE:
                    return
                frame = protocol.decode_command(bytes(self._buffer))
                if frame is not None:
                    self._buffer = bytearray()
                    self._take_frame(*frame)
                    return
                self._reject()
            byte = self._buffer[0]
            self._buffer = self._buffer[1:]
            self._take_text(byte)

    def _take_frame(self, sequence, left, right):
        self._line = bytearray()
        self._skipping = False
        ahead = (sequence - self._sequence) & 0xFF
        if (left or right) and not (self._ready and 1 <= ahead <= WINDOW):
            return self._reject()
        self._sequence = sequence
        self._ready = True
        self.framed = True
        self._obey(left, right, "frame")

    def _take_text(self, byte):
        if byte == NEWLINE:
            if not self._skipping:
                self._take_line(bytes(self._line))
            self._line = bytearray()
            self._skipping = False
            return
        if self._skipping:
            return
        self._line.append(byte)
        # An HM-10 that loses its partner says so on its serial line, without a newline.
        if bytes(self._line[-7:]) == b"OK+LOST":
            self._line = bytearray()
            self._stop_by_itself()
        elif len(self._line) > LONGEST_LINE:
            self._line = bytearray()
            self._skipping = True
            self._reject()

    def _take_line(self, text):
        if not text:
            return
        power = protocol.parse_plain_line(text)
        if power is None or (self.framed and self.fed and power != (0, 0)):
            return self._reject()
        if not self.fed:
            self.framed = False
        self._obey(power[0], power[1], "line")

    def _obey(self, left, right, answer):
        self.motors = (left, right)
        self._fed_at = self._now
        self.fed = True
        self._pending = answer

    def _stop_by_itself(self):
        self.motors = (0, 0)
        self.fed = False
        self._ready = False
        self.stops = (self.stops + 1) & 0xFF

    def _reject(self):
        self.rejected = (self.rejected + 1) & 0xFF

    def _answer(self, senses):
        pending = self._pending
        self._pending = None
        if pending == "frame":
            left, right, battery_mv = senses()
            return protocol.answer_frame(
                self._sequence, self.stops, left, right, battery_mv, self.rejected
            )
        if pending == "line":
            if self._answered_at is None or (
                (self._now - self._answered_at) & TICKS >= PLAIN_ANSWER_MS
            ):
                self._answered_at = self._now
                return protocol.answer_line(*senses())
        return b""
