// Holds what the board tells of its encoders against what the head did: every count of every tick, and when each edge came. Keeps where the light
// really was by the plan's clock.

import { Reader } from './rows.mjs'

const TICK_NS = 1e6
const MOMENT_NS = 100
const TICKING_SLICE = 7
const CSR = 0
const ENABLED = 1

export class Check {
  constructor(chip, head) {
    Object.assign(this, { head, began: null, ticks: 0, wrong: 0, stamps: 0, missing: 0, furthestNs: 0, counted: -1, spots: [], light: [] })
    const slice = chip.mcu.pwm.channels[TICKING_SLICE]
    const write = slice.writeRegister.bind(slice)
    slice.writeRegister = (offset, value) => {
      write(offset, value)
      if (offset !== CSR || !(value & ENABLED) || this.began !== null) return
      this.began = chip.now
      chip.every(TICK_NS, () => this.spots.push([head.plant.spot(0), head.plant.spot(1), head.plant.light()]))
    }
    this.reader = new Reader(row => this.told(row))
  }

  take(bytes) {
    this.reader.take(bytes)
  }

  told({ tick, planTick, counts, ages }) {
    // rows that are told again were looked at
    if (tick <= this.counted) return
    this.counted = tick
    this.ticks++
    this.light.push([tick, planTick, ...this.spots[tick]])
    const at = this.began + (tick + 1) * TICK_NS
    for (const joint of [0, 1]) this.hold(at, joint, counts[joint], ages[joint])
  }

  // An edge in the moment of the tick belongs to it or to the next one.
  hold(at, joint, count, age) {
    const reads = [at, at - MOMENT_NS, at + MOMENT_NS].map(ns => this.head.read(joint, ns))
    const { since } = reads.find(read => read.count === count) ?? {}
    if (since === undefined) {
      this.wrong++
      return
    }
    const trueNs = at - since
    if (age === null) this.missing += trueNs < TICK_NS - MOMENT_NS
    else {
      this.stamps++
      this.furthestNs = Math.max(this.furthestNs, Math.abs(age * TICK_NS - trueNs))
    }
  }

  // Tick, plan's clock, x and y on the wall in m, lit: a line of CSV each.
  csv() {
    return ['tick,plan_tick,x_m,y_m,light', ...this.light.map(row => row.join(','))].join('\n') + '\n'
  }

  summary() {
    const { ticks, wrong, stamps, missing, furthestNs } = this
    return { ticks, counts_wrong: wrong, stamps, stamps_missing: missing, stamps_off_us: furthestNs / 1000 }
  }
}
