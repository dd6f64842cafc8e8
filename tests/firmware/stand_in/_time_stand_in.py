"""A clock that a script sets; main.py reads it once at the start of each turn."""

import bench


def ticks_ms():
    bench.start_turn()
    return bench.now_ms & 0x3FFFFFFF


def ticks_diff(later, earlier):
    return ((later - earlier + 0x20000000) & 0x3FFFFFFF) - 0x20000000
