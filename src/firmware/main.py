"""rift's listener for the Pololu 3pi+ 2040: radio bytes in, wheel powers out.

Copy main.py, rift_listener.py and rift_protocol.py to the robot's USB drive. A Bluetooth module
(HM-10, HC-05) is wired to GP28 (robot's TX, to the module's RX) and GP29 (robot's RX).
"""

import time

from machine import UART, Pin
from pololu_3pi_2040_robot import robot

from rift_listener import Listener

BAUD = 9600
UART_NUMBER, TX_PIN, RX_PIN = 0, 28, 29
FULL_SPEED = 6000  # what Pololu's Motors.set_speeds takes as full power
DISPLAY_MS = 500
# Drawing takes milliseconds, in which the buffer must hold what comes; the hardware's has 32 bytes.
RECEIVE_BUFFER = 512


class Wheels:
    """Tells the motors only what changes; nothing else moves them."""

    def __init__(self):
        self._motors = robot.Motors()
        self._set = None
        self.set((0, 0))

    def set(self, milli):
        if milli != self._set:
            self._motors.set_speeds(
                milli[0] * FULL_SPEED // 1000, milli[1] * FULL_SPEED // 1000
            )
            self._set = milli

    def off(self):
        self._motors.off()
        self._set = None


class Screen:
    def __init__(self):
        self._display = robot.Display()
        self._shown_at = None

    def show(self, now_ms, listener, battery_mv):
        if self._shown_at is not None and (
            time.ticks_diff(now_ms, self._shown_at) < DISPLAY_MS
        ):
            return
        self._shown_at = now_ms
        if not listener.fed:
            state = "waiting" if listener.stops == 0 else "STOPPED"
        else:
            state = "framed" if listener.framed else "plain"
        self._lines(
            (
                "rift " + state,
                "L %d R %d" % listener.motors,
                "stops %d" % listener.stops,
                "rejected %d" % listener.rejected,
                "%d mV" % battery_mv,
            )
        )

    def fail(self, error):
        self._lines(("rift FAILED", str(error)[:16], str(error)[16:32]))

    def _lines(self, lines):
        self._display.fill(0)
        for i, line in enumerate(lines):
            self._display.text(line, 0, 12 * i)
        self._display.show()


def run(wheels, screen):
    uart = UART(
        UART_NUMBER, baudrate=BAUD, tx=Pin(TX_PIN), rx=Pin(RX_PIN), rxbuf=RECEIVE_BUFFER
    )
    encoders = robot.Encoders()
    battery = robot.Battery()
    listener = Listener()

    def senses():
        left, right = encoders.get_counts()
        return left, right, battery.get_level_millivolts()

    while True:
        now_ms = time.ticks_ms()
        waiting = uart.any()
        data = uart.read(waiting) if waiting else None
        answer = listener.poll(now_ms, data or b"", senses)
        wheels.set(listener.motors)
        if answer:
            uart.write(answer)
        # While the robot drives, the display keeps what it shows: nothing may be late.
        if listener.motors == (0, 0):
            screen.show(now_ms, listener, battery.get_level_millivolts())


def main():
    wheels = Wheels()
    screen = Screen()
    try:
        run(wheels, screen)
    except Exception as error:
        wheels.off()
        screen.fail(error)
        raise
    finally:
        wheels.off()


main()
