// The simulated head behind the pins of the chip.

export const PINS = {
  light: 19, gate: 14, enable: 13, amplifiers: 12, heartbeat: 15,
  stop: 16, lid: 17, key: 18, panFault: 20, tiltFault: 21,
  seesLight: 0, hasConverter: 1, gyroscope: 22,
}
// Lines A and B of each encoder, and slices of each bridge.
const ENCODERS = [[2, 3], [4, 5]]
const BRIDGES = [4, 5]
// Both lines by the count's remainder of four.
const LINES = [[false, false], [true, false], [true, true], [false, true]]
// Volts are looked at so often, ns: twice in a period of the bridges.
const PART_NS = 25_000
// Registers of the gyroscope that are read, and what it says that it is.
const WHO_AM_I = 0x8f
const TURNING = 0xa2
const NAME = 0x6c
const STEP_RAD_S = 8.75e-3 * Math.PI / 180
// As much of the past is kept, edges of each joint.
const MOST_KEPT = 4096

export class Head {
  constructor(chip, plant, { seed = 1, gyroscope = false } = {}) {
    Object.assign(this, { chip, plant, kept: [[], []], cut: [[], []], swapped: [false, false], wasOn: false, isHeld: false })
    plant.begin(seed, gyroscope ? 1 : 0)
    for (const joint of [0, 1]) {
      this.kept[joint].push([-Infinity, plant.count(joint)])
      this.show(joint, plant.count(joint))
    }
    for (const pin of [PINS.stop, PINS.lid, PINS.key]) chip.set(pin, false)
    for (const pin of [PINS.panFault, PINS.tiltFault]) chip.set(pin, true)
    chip.set(PINS.seesLight, false)
    chip.set(PINS.hasConverter, true)
    if (gyroscope) this.fitGyroscope()
    chip.every(PART_NS, () => this.pass())
  }

  // The next while: its edges come when they come.
  pass() {
    const { chip, plant } = this
    const on = chip.isHigh(PINS.amplifiers)
    // somebody holds it straight ahead until its motors do: an arm out of balance would sink
    this.wasOn ||= on
    if (!this.wasOn || this.isHeld) return
    const [pan, tilt] = BRIDGES.map(slice => chip.duties(slice)).map(([a, b]) => on ? a - b : 0)
    const count = plant.pass(pan, tilt, chip.isHigh(PINS.gate), chip.isHigh(PINS.enable), PART_NS / 1e9)
    const edges = new Float64Array(plant.memory.buffer, plant.edges(), 3 * count).slice()
    for (let n = 0; n < edges.length; n += 3) {
      const [joint, at, afterS] = edges.subarray(n, n + 3)
      chip.after(afterS * 1e9, () => this.edge(joint, at))
    }
    chip.set(PINS.light, plant.light() === 1)
  }

  edge(joint, count) {
    const kept = this.kept[joint]
    kept.push([this.chip.now, count])
    if (kept.length > MOST_KEPT) kept.splice(0, MOST_KEPT / 2)
    this.show(joint, count)
  }

  show(joint, count) {
    const lines = LINES[((count % 4) + 4) % 4]
    ENCODERS[joint].forEach((pin, n) => {
      // a line that is cut is pulled up
      this.chip.setSeen(pin, this.cut[joint].includes(n) || lines[this.swapped[joint] ? 1 - n : n])
    })
  }

  // Shows the lines as they are now: one was cut, or both were swapped.
  showAgain(joint) {
    this.show(joint, this.kept[joint].at(-1)[1])
  }

  // What an encoder read at a time, ns, and when it came to that.
  read(joint, at) {
    const kept = this.kept[joint]
    let n = kept.length - 1
    while (n > 0 && kept[n][0] > at) n--
    return { count: kept[n][1], since: kept[n][0] }
  }

  fitGyroscope() {
    const bus = this.chip.mcu.spi[1]
    let bytes = []
    this.chip.watch(PINS.gyroscope, isHigh => { if (isHigh) bytes = [] })
    bus.onTransmit = byte => {
      const [register] = bytes
      const n = bytes.length - 1
      bytes.push(byte)
      let said = 0
      if (register === WHO_AM_I) said = NAME
      if (register === TURNING) said = (Math.round(this.plant.turning(n >> 1) / STEP_RAD_S) >> (8 * (n & 1))) & 0xff
      bus.completeTransmit(said)
    }
  }
}
