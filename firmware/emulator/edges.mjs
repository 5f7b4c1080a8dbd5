// Turns both encoders faster than any head, 8192 counts a turn, and holds every count and stamp that the board tells against them; then starts the board a
// hundred times, and looks whether its gate ever opens by itself.
//
//     node edges.mjs IMAGE MODULE

import { Check } from './check.mjs'
import { Chip } from './chip.mjs'
import { Head, PINS } from './head.mjs'
import { Host, openWorld } from './world.mjs'

const [image, module] = process.argv.slice(2)
const MS = 1e6
// Speed swings between both ways, rad/s, so often.
const MOST_RAD_S = 24
const SWINGS_HZ = 3
const COUNTS_A_TURN = 8192
const LASTS_MS = 2000
const MOST_OFF_US = 0.2
const RESETS = 100
const STARTS_MS = 150
const RUNNING = 1

const wrong = []
const hold = (is, what) => {
  if (!is) wrong.push(what)
}

// Edges of an encoder that swings, ns: those of one moment to the next are found by halving.
const swing = (chip, head, joint, from) => {
  const phase = joint * 0.7
  const rate = 2 * Math.PI * SWINGS_HZ
  const counts = ns => MOST_RAD_S / rate * (Math.cos(phase) - Math.cos(rate * (ns - from) / 1e9 + phase)) * COUNTS_A_TURN / (2 * Math.PI)
  const at = (ns, next, count) => {
    let [early, late] = [ns, next]
    const isUp = counts(next) > counts(ns)
    for (let n = 0; n < 40; n++) {
      const middle = (early + late) / 2
      if (counts(middle) >= count === isUp) late = middle
      else early = middle
    }
    return Math.round(late)
  }
  const STEP_NS = 10_000
  const first = head.kept[joint].at(-1)[1]
  let now = first
  chip.every(STEP_NS, () => {
    const [ns, next] = [chip.now, chip.now + STEP_NS]
    const to = first + Math.floor(counts(next) + 0.5)
    const way = Math.sign(to - now)
    for (; now !== to; now += way) {
      const count = now + way
      const edge = (way > 0 ? count : now) - first - 0.5
      chip.after(at(ns, next, edge) - ns, () => head.edge(joint, count))
    }
  })
}

const edges = () => {
  const chip = new Chip(image)
  const world = openWorld(module)
  const head = new Head(chip, world)
  head.isHeld = true
  const check = new Check(chip, head)
  const host = new Host(world, 1)
  let said = Buffer.alloc(0)
  const pass = ms => {
    for (const end = chip.now + ms * MS; chip.now < end;) {
      chip.take(host.says(said, chip.now))
      said = chip.run(MS / 4)
      check.take(said)
    }
  }
  pass(300)
  for (const joint of [0, 1]) swing(chip, head, joint, chip.now)
  pass(LASTS_MS)
  const seen = check.summary()
  console.log(`${seen.ticks} ticks, ${seen.stamps} stamps: ${seen.counts_wrong} counts wrong, ${seen.stamps_missing} stamps missing, ${seen.stamps_off_us.toFixed(3)} µs off at most`)
  hold(seen.stamps > 2 * LASTS_MS * 0.9, `${seen.stamps} edges were stamped`)
  hold(seen.counts_wrong === 0 && seen.stamps_missing === 0 && seen.stamps_off_us <= MOST_OFF_US, 'counts and stamps are not those of the lines')
}

// Gate and enable from power-up on: with nobody there, with bytes that mean nothing, with a host that configures the board and homes the head, and no more.
const resets = () => {
  let highs = 0
  for (let n = 0; n < RESETS; n++) {
    const chip = new Chip(image)
    const head = new Head(chip, openWorld(module), { seed: n })
    const host = new Host(head.plant, n + 1, { arms: false })
    chip.watch(PINS.gate, isHigh => { highs += isHigh })
    chip.watch(PINS.enable, isHigh => { highs += isHigh })
    let said = Buffer.alloc(0)
    for (let ms = 0; ms < STARTS_MS; ms++) {
      if (n % 3 === 1) chip.take(Buffer.from([ms, 0x21, 0, n, 255, 0]))
      if (n % 3 === 2) chip.take(host.says(said, chip.now))
      said = chip.run(MS)
    }
    if (n % 3 === 2) hold(host.stage === RUNNING, 'the host did not configure the board')
  }
  console.log(`${RESETS} starts: the gate or the enable rose ${highs} times`)
  hold(highs === 0, 'the gate opened by itself')
}

edges()
resets()
if (wrong.length > 0) {
  console.error(wrong.join('\n'))
  process.exit(1)
}
