#!/usr/bin/env python3
"""Greets a board and says what it is, then how long its answers take: docs/wire-format.md in Python, with nothing but the standard library.

    tracelight rig serve --pty out/head &
    python3 examples/board.py out/head
"""

import os
import select
import struct
import sys
import time
import tty
import zlib


def stuffed(data):
    """COBS: the same without a zero byte."""
    out, run = bytearray(), bytearray()
    for byte in data:
        if byte:
            run.append(byte)
        if not byte or len(run) == 254:
            out += bytes([len(run) + 1]) + run
            run.clear()
    return bytes(out + bytes([len(run) + 1]) + run)


def unstuffed(data):
    """And back; None if it is none."""
    out, at = bytearray(), 0
    while at < len(data):
        run = data[at]
        if run == 0 or at + run > len(data):
            return None
        out += data[at + 1 : at + run]
        at += run
        if run < 255 and at < len(data):
            out.append(0)
    return bytes(out)


def packet(kind, payload, connection=0, sequence=0):
    body = struct.pack("<BBH", kind, connection, sequence) + payload
    return stuffed(body + struct.pack("<I", zlib.crc32(body))) + b"\0"


class Board:
    def __init__(self, path, session=0x5EED01):
        self.port = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.port)
        self.session, self.left = session, b""

    def say(self, kind, payload=b"", sequence=0):
        os.write(self.port, packet(kind, payload, 0 if kind == 0x01 else self.session & 0xFF, sequence))

    def bodies(self, wait_s):
        """What comes within a while: kind and payload of each packet whose checksum is right."""
        until = time.monotonic() + wait_s
        while (left := until - time.monotonic()) > 0:
            if not select.select([self.port], [], [], left)[0]:
                return
            self.left += os.read(self.port, 4096)
            *whole, self.left = self.left.split(b"\0")
            for data in filter(None, map(unstuffed, whole)):
                body, checksum = data[:-4], data[-4:]
                if struct.pack("<I", zlib.crc32(body)) == checksum:
                    yield body[0], body[4:]

    def answer(self, kind, wait_s=0.5):
        return next((payload for got, payload in self.bodies(wait_s) if got == kind), None)


def main(path):
    board = Board(path)
    greeting = None
    for _ in range(4):
        board.say(0x01, b"TLHT" + struct.pack("<BBI8s", 1, 0, board.session, b"board.py"))
        for kind, payload in board.bodies(0.5):
            if kind == 0x81 and struct.unpack_from("<I", payload, 6)[0] == board.session:
                greeting = payload
                break
        if greeting:
            break
    if not greeting:
        sys.exit(f"{path}: no board answers")
    magic, major, minor, session = struct.unpack_from("<4sBBI", greeting)
    firmware, source, kind, name = struct.unpack_from("<3s8sH8s", greeting, 10)
    tick_ns, segments, rows, has, configured, crc, reset, tick, nonce = struct.unpack_from("<IHHIBIBII", greeting, 31)
    print(f"{magic.decode()} wire {major}.{minor}, program {'.'.join(map(str, firmware))}, board {kind} {name.decode(errors='replace')}")
    print(f"up {tick * tick_ns * 1e-9:.1f} s, {segments} segments ahead, {rows} ticks again, has {has:#010x}, configured {bool(configured)}")
    times = []
    for number in range(20):
        began = time.monotonic()
        board.say(0x20, struct.pack("<Q", number))
        answer = board.answer(0xA0)
        if answer is None or struct.unpack_from("<Q", answer)[0] != number:
            sys.exit(f"{path}: a keep-alive was not answered")
        times.append(1e3 * (time.monotonic() - began))
    times.sort()
    print(f"there and back in {times[len(times) // 2]:.2f} ms, at most {times[-1]:.2f} ms")


if __name__ == "__main__":
    main(sys.argv[1])
