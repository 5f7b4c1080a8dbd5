// What the board tells of its ticks, read as docs/wire-format.md has it.

const ROWS = 0x90
const HEADER = 4
const ROWS_HEADER = 15
const ROW = 32
const GYROSCOPE = 12
const HAS_GYROSCOPE = 1 << 13
const NO_EDGE = 65535

const unpacked = packet => {
  const out = []
  for (let n = 0; n < packet.length;) {
    const code = packet[n]
    out.push(...packet.subarray(n + 1, n + code))
    n += code
    if (code < 255 && n < packet.length) out.push(0)
  }
  return Buffer.from(out)
}

export class Reader {
  constructor(told) {
    this.told = told
    this.rest = Buffer.alloc(0)
  }

  take(bytes) {
    this.rest = Buffer.concat([this.rest, bytes])
    for (let end = this.rest.indexOf(0); end >= 0; end = this.rest.indexOf(0)) {
      const body = unpacked(this.rest.subarray(0, end))
      this.rest = this.rest.subarray(end + 1)
      if (body[0] === ROWS) this.rows(body.subarray(HEADER))
    }
  }

  rows(body) {
    const first = body.readUInt32LE(0)
    const count = body[ROWS_HEADER - 1]
    for (let n = 0, at = ROWS_HEADER; n < count; n++) {
      const bits = body.readUInt16LE(at + 26)
      const age = joint => {
        const stamp = body.readUInt16LE(at + 12 + 2 * joint)
        return stamp === NO_EDGE ? null : stamp / 65536
      }
      this.told({
        tick: first + n,
        planTick: body.readUInt32LE(at),
        counts: [body.readInt32LE(at + 4), body.readInt32LE(at + 8)],
        ages: [age(0), age(1)],
        gate: (bits & 1) === 1,
        fault: body[at + 28],
      })
      at += ROW + (bits & HAS_GYROSCOPE ? GYROSCOPE : 0)
    }
  }
}
