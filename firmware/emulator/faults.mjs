// What goes wrong with the board, at moments of a circle that is drawn: how soon it is dark, and what its host is told.
//
//     node faults.mjs IMAGE MODULE SCENARIOS [MOMENTS [SHARE/SHARES]]

import { readFileSync } from 'node:fs'
import { Check } from './check.mjs'
import { Chip } from './chip.mjs'
import { Head, PINS } from './head.mjs'
import { Host, openWorld } from './world.mjs'

const [image, module, scenarios, moments = '1', part = '1/1'] = process.argv.slice(2)
// which of so many shares of the scenarios, so that several processors have some
const [share, shares] = part.split('/').map(Number)
const MS = 1e6
// Bytes go to and fro so often, ns.
const PIECE_NS = 0.25 * MS
// The circle is lit within, and a moment lies within so much after that.
const MOST_BEFORE_MS = 6000
const WITHIN_MS = 3000
// After it is seen what becomes of it.
const AFTER_MS = 300
const STOPS = { 'emergency-stop': PINS.stop, lid: PINS.lid, key: PINS.key, 'amplifier-pan': PINS.panFault, 'amplifier-tilt': PINS.tiltFault }
const LINES = { a: 0, b: 1 }
// An instruction that jumps to itself, where nothing else is in flash.
const LOOP = 0xe7fe
const LOOP_AT = 0x100000
const FLASH = 0x10000000

// Draws numbers that look random, by a seed: mulberry32.
const dice = seed => () => {
  seed = (seed + 0x6d2b79f5) | 0
  let t = Math.imul(seed ^ (seed >>> 15), 1 | seed)
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t
  return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32
}

const wrong = []
const hold = (is, what) => {
  if (!is) wrong.push(what)
}

class Bench {
  constructor(seed, gyroscope = false) {
    this.chip = new Chip(image)
    this.world = openWorld(module)
    this.head = new Head(this.chip, this.world, { seed, gyroscope })
    this.check = new Check(this.chip, this.head)
    this.host = new Host(this.world, seed + 1)
    this.said = Buffer.alloc(0)
    this.beats = []
    this.shut = null
    this.chip.watch(PINS.gate, isHigh => { this.shut = isHigh ? null : this.chip.now })
    this.chip.watch(PINS.heartbeat, () => this.beats.push(this.chip.now))
    const { flashView } = this.chip.mcu
    flashView.setUint16(LOOP_AT, LOOP, true)
  }

  // When the gate fell, ns, if it is not up again.
  get shutAt() {
    return this.shut ?? this.chip.resetAt
  }

  get isLit() {
    return this.chip.isHigh(PINS.gate) && this.world.light() === 1
  }

  // Time passes, until something holds or so many ms are over.
  pass(ms, until = () => false) {
    const end = this.chip.now + ms * MS
    while (this.chip.now < end && !until()) {
      this.chip.take(this.host.says(this.said, this.chip.now))
      this.said = this.chip.run(PIECE_NS)
      this.check.take(this.said)
    }
  }
}

// Does what a scenario says, and undoes it.
const does = ({ open, silent, hangs, bump_rad: bumpRad, cut, swapped }, { chip, head, host, world }, joint) => {
  if (bumpRad) {
    world.bump(bumpRad, 0)
    return () => {}
  }
  if (open) {
    const isHighToStop = !open.startsWith('amplifier')
    chip.set(STOPS[open], isHighToStop)
    return () => chip.set(STOPS[open], !isHighToStop)
  }
  if (silent) {
    host.isSilent = true
    return () => { host.isSilent = false }
  }
  if (hangs) {
    const { core } = chip.mcu
    core.PM = hangs === 'processor'
    // the main loop, not an interrupt, is to hang
    if (hangs === 'loop') while (core.IPSR !== 0) chip.run(1000)
    core.waiting = false
    core.PC = FLASH + LOOP_AT
    return () => {}
  }
  if (cut) head.cut[joint] = cut.map(line => LINES[line])
  if (swapped) head.swapped[joint] = true
  head.showAgain(joint)
  return () => {}
}

const run = (scenario, seed) => {
  const roll = dice(seed)
  const bench = new Bench(seed, scenario.gyroscope)
  const { chip, head, host } = bench
  const named = `${scenario.name} (moment ${seed})`
  bench.pass(MOST_BEFORE_MS, () => bench.isLit)
  if (!bench.isLit) throw new Error(`${named}: nothing was lit: ${host.trouble ?? host.fault ?? 'nobody knows why'}`)
  bench.pass(roll() * WITHIN_MS)
  while (!bench.isLit) bench.pass(1)
  chip.run(Math.round(roll() * MS))
  const joint = roll() < 0.5 ? 0 : 1
  const at = chip.now
  const before = head.kept[joint].length
  const undo = does(scenario, bench, joint)
  if (scenario.lasts_ms) chip.after(scenario.lasts_ms * MS, undo)
  const told = { ms: null }
  bench.pass(Math.max(AFTER_MS, scenario.fault_ms ?? 0, scenario.goes_on ? 3000 : 0, scenario.after_counts ? 1500 : 0), () => {
    if (bench.shutAt !== null && told.ms === null) told.ms = (bench.shutAt - at) / MS
    return scenario.goes_on && told.ms !== null && bench.isLit
  })
  if (bench.shutAt !== null && told.ms === null) told.ms = (bench.shutAt - at) / MS
  // what an encoder does not show is seen once its joint has moved
  const moved = head.kept[joint][before + (scenario.after_counts ?? 0) - 1]?.[0]
  const from = scenario.after_counts ? ((moved ?? Infinity) - at) / MS : 0
  const took = told.ms === null ? null : Math.max(0, told.ms - Math.max(0, from))
  if (scenario.dark_ms) {
    hold(took !== null && took <= scenario.dark_ms, `${named}: the gate fell after ${took?.toFixed(3) ?? 'no'} ms, of ${scenario.dark_ms}`)
  } else if (!scenario.resets_ms) {
    hold(told.ms === null, `${named}: the gate fell after ${told.ms} ms`)
  }
  if (scenario.fault) hold(host.fault === scenario.fault, `${named}: the host was told of ${host.fault}`)
  if (scenario.goes_on) hold(bench.isLit, `${named}: it did not go on`)
  const beat = (bench.beats.at(-1) - at) / MS
  if (scenario.resets_ms) {
    const reset = chip.resetAt === null ? null : (chip.resetAt - at) / MS
    hold(reset !== null && reset <= scenario.resets_ms, `${named}: the watchdog came after ${reset?.toFixed(3) ?? 'no'} ms, of ${scenario.resets_ms}`)
    if (scenario.heartbeat_ms) hold(beat <= scenario.heartbeat_ms, `${named}: the heart beat for ${beat} ms`)
    return scenario.dark_ms ? took : reset
  }
  return took
}

const mine = JSON.parse(readFileSync(scenarios)).filter((_, n) => n % shares === share - 1)
for (const scenario of mine) {
  const took = []
  for (let seed = 1; seed <= Number(moments); seed++) took.push(run(scenario, seed))
  const most = Math.max(...took.map(ms => ms ?? -1))
  console.log(`${scenario.name}: ${most < 0 ? 'nothing' : `${most.toFixed(3)} ms at most`}`)
}
if (wrong.length > 0) {
  console.error(wrong.join('\n'))
  process.exit(1)
}
