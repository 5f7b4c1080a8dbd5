"""Reads a run log with the public MCAP package and prints what is in it.

    pip install mcap mcap-protobuf-support
    python read_mcap.py out/star/run.mcap

A log of a killed run has no index and no end; it is read up to its last whole record. Exit status 1 if the ticks
do not follow each other or a topic is missing.
"""

import os
import struct
import sys
from collections import Counter

from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, make_reader
from mcap_protobuf.decoder import DecoderFactory

MAGIC = b"\x89MCAP0\r\n"  # a log begins and ends with it
TOPICS = ("/telemetry", "/spot", "/plan")


def messages(file):
    """Every decoded message, until the file ends, however it ends."""
    file.seek(-len(MAGIC), os.SEEK_END)
    is_whole = file.read() == MAGIC
    file.seek(0)
    if not is_whole:
        print("no end: a run that was cut off")
    reader = (make_reader if is_whole else NonSeekingReader)(file, decoder_factories=[DecoderFactory()])
    try:
        for _, channel, _, decoded in reader.iter_decoded_messages(log_time_order=False):
            yield channel.topic, decoded
    except (EndOfFile, struct.error):
        if is_whole:
            raise


def main(path):
    counts = Counter()
    ticks = []
    worst = 0.0
    with open(path, "rb") as file:
        for topic, message in messages(file):
            counts[topic] += 1
            if topic == "/telemetry":
                ticks.append((message.lap, message.tick))
            elif topic == "/spot" and message.light:
                worst = max(worst, message.error_mm)
            elif topic == "/faults":
                print(f"{message.timestamp.seconds}.{message.timestamp.nanos:09d} s: {message.message}")
    for topic, count in sorted(counts.items()):
        print(f"{topic:12} {count}")
    print(f"largest error while lit: {worst:.3f} mm")
    consecutive = all(b == (a[0], a[1] + 1) or b[0] == a[0] + 1 for a, b in zip(ticks, ticks[1:]))
    if not ticks or not consecutive or any(counts[topic] == 0 for topic in TOPICS):
        sys.exit("the log is not whole: ticks are missing")


if __name__ == "__main__":
    main(sys.argv[1])
