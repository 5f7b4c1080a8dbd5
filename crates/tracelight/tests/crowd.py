"""A crowd looks at a run of the studio: python3 crowd.py PROGRAM SECONDS CLIENTS [MINUTES]

One page operates a job by the clock; the others have a socket each, and one of them reads nothing at all. Told are the ticks that came late, with the crowd and without, how long a stop takes,
and, over MINUTES of further runs and plans, how much memory the program takes. Nothing but Python's own library is needed.
"""

import base64
import json
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request


# how often a run is stopped
STOPS = 100


class Line:
    """A WebSocket as far as it is needed: texts both ways."""

    def __init__(self, port, page):
        self.socket = socket.create_connection(("127.0.0.1", port))
        key = base64.b64encode(os.urandom(16)).decode()
        head = (
            f"GET /api/v1/live?page={page} HTTP/1.1\r\nhost: 127.0.0.1:{port}\r\nconnection: upgrade\r\nupgrade: websocket\r\n"
            f"sec-websocket-version: 13\r\nsec-websocket-key: {key}\r\norigin: http://127.0.0.1:{port}\r\n\r\n"
        )
        self.socket.sendall(head.encode())
        self.rest = b""
        while b"\r\n\r\n" not in self.rest:
            self.rest += self.socket.recv(4096)
        answer, self.rest = self.rest.split(b"\r\n\r\n", 1)
        assert b" 101 " in answer.split(b"\r\n")[0], answer

    def say(self, what):
        text, mask = json.dumps(what).encode(), os.urandom(4)
        masked = bytes(byte ^ mask[n % 4] for n, byte in enumerate(text))
        assert len(text) < 126
        self.socket.sendall(bytes([0x81, 0x80 | len(text)]) + mask + masked)

    def take(self, count):
        while len(self.rest) < count:
            more = self.socket.recv(65536)
            if not more:
                raise EOFError
            self.rest += more
        taken, self.rest = self.rest[:count], self.rest[count:]
        return taken

    def hear(self):
        first, length = self.take(2)
        if length == 126:
            (length,) = struct.unpack(">H", self.take(2))
        elif length == 127:
            (length,) = struct.unpack(">Q", self.take(8))
        body = self.take(length)
        if first & 15 == 8:
            raise EOFError
        return json.loads(body) if first & 15 == 1 else None


class Studio:
    def __init__(self, program, folder):
        self.process = subprocess.Popen(
            [program, "studio", "--port", "0", "--no-open", "--folder", folder],
            stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True,
        )
        self.port = int(re.search(r"127\.0\.0\.1:(\d+)/", self.process.stderr.readline()).group(1))

    def ask(self, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}/api/v1{path}", data, timeout=120) as answer:
            return json.load(answer)

    def memory_mb(self):
        with open(f"/proc/{self.process.pid}/status") as status:
            return int(re.search(r"VmRSS:\s+(\d+)", status.read()).group(1)) / 1024


def attended(studio, seconds, readers, stalled):
    """Operates a run for so long while others look on: ticks, late ones, and the latest, ms."""
    lines = [Line(studio.port, f"reader-{n}") for n in range(readers)]
    if stalled:
        # what is sent to it stays with the system and the program
        stuck = Line(studio.port, "stuck")
        stuck.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    heard = [0] * readers

    def read(n):
        try:
            while True:
                lines[n].hear()
                heard[n] += 1
        except (EOFError, OSError):
            pass

    threads = [threading.Thread(target=read, args=(n,), daemon=True) for n in range(readers)]
    for thread in threads:
        thread.start()
    mine = Line(studio.port, "mine")
    studio.ask("/jobs", {"picture": "house.png", "page": "mine", "attended": True, "flags": {"width": "2m", "real_time": "1"}})
    until, armed, here, told = time.monotonic() + seconds, False, 0.0, {}
    while time.monotonic() < until:
        event = mine.hear()
        if time.monotonic() - here > 0.3:
            here = time.monotonic()
            mine.say({"here": True})
        if event is None:
            continue
        if event["event"] == "over":
            break
        if event["event"] == "progress":
            told = event
            if event["state"] == "ready" and not armed:
                armed = True
                mine.say({"wish": "arm"})
            elif event["state"] == "armed":
                mine.say({"wish": "go-on"})
            elif event["state"] == "done":
                break
    ended(studio, mine)
    for line in lines + [mine]:
        line.socket.close()
    assert not readers or min(heard) > 10, heard
    return round(1000 * told["t_s"]), told["late_ticks"], told["latest_ms"]


def ended(studio, mine):
    """Ends a run, and waits until it is over."""
    mine.say({"wish": "end"})
    while not studio.ask("/jobs/current")["job"]["over"]:
        time.sleep(0.1)


def stopped(studio, trials):
    """Stops a lit run by a click's request, again and again: ms from the request to the state that a page is told, which is after the rig's."""
    mine = Line(studio.port, "mine")
    studio.ask("/jobs", {"picture": "house.png", "page": "mine", "attended": True, "flags": {"width": "3m", "distance": "4m", "speed": "10cm/s", "real_time": "1"}})
    took, asked, here, wished = [], None, 0.0, 0.0
    while len(took) < trials:
        now = time.monotonic()
        if now - here > 0.3:
            here = now
            mine.say({"here": True})
        event = mine.hear()
        now = time.monotonic()
        if event is None:
            continue
        assert event["event"] != "over", event
        if event["event"] == "state" and asked and event["to"] not in ("tracing", "armed"):
            took.append(1000 * (now - asked))
            asked = None
        if event["event"] == "progress" and asked is None and now - wished > 0.25:
            if event["state"] == "tracing" and event["gate"]:
                asked = time.monotonic()
                studio.ask("/stop", {})
            elif event["state"] in ("armed", "paused"):
                wished = now
                mine.say({"wish": "go-on"})
            else:
                wished = now
                mine.say({"wish": "arm"})
    ended(studio, mine)
    mine.socket.close()
    return sorted(took)


def main():
    program, seconds, clients = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
    minutes = float(sys.argv[4]) if len(sys.argv) > 4 else 0
    with tempfile.TemporaryDirectory() as folder:
        studio = Studio(program, folder)
        try:
            for name, readers, stalled in [("nobody looks on", 0, False), (f"{clients} look on, one of them stalled", clients - 1, True)]:
                ticks, late, latest = attended(studio, seconds, readers, stalled)
                print(f"{name}: of {ticks} ticks {late} came more than 1 ms late ({100 * late / ticks:.3f} %), the latest {latest:.1f} ms", flush=True)
            took = stopped(studio, STOPS)
            print(f"stopped {STOPS} times: {took[STOPS // 2]:.1f} ms in the middle, {took[int(0.99 * STOPS)]:.1f} ms in 99 of 100, {took[-1]:.1f} ms at most")
            began, least, most = time.monotonic(), None, None
            while time.monotonic() < began + 60 * minutes:
                attended(studio, 20, clients - 1, True)
                for width in range(20, 30):
                    studio.ask("/plans", {"picture": "house.png", "page": "mine", "number": 0, "flags": {"width": f"{width}cm"}})
                memory = studio.memory_mb()
                # what is kept of plans and threads is there after the first minutes
                if time.monotonic() > began + 120:
                    least, most = min(least or memory, memory), max(most or memory, memory)
                print(f"after {(time.monotonic() - began) / 60:.1f} min {memory:.1f} MB", flush=True)
            if least:
                print(f"memory from {least:.1f} to {most:.1f} MB")
        finally:
            studio.process.terminate()
            studio.process.wait()


main()
