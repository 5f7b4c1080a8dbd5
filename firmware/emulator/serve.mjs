// The emulated board as a program with a line: bytes of a host come in, the board's go out. What was seen is written to REPORT.json and REPORT.csv when it ends.
//
//     socat PTY,link=out/board,raw,echo=0 EXEC:"node serve.mjs IMAGE MODULE [SEED] [REPORT]",pipes

import { writeFileSync } from 'node:fs'
import { Check } from './check.mjs'
import { Chip } from './chip.mjs'
import { Head, PINS } from './head.mjs'
import { openWorld } from './world.mjs'

const [image, module, seed = '1', report] = process.argv.slice(2)
// Time passes in pieces, ns; never faster than on the wall.
const PIECE_NS = 1e6

const chip = new Chip(image)
const head = new Head(chip, openWorld(module), { seed: Number(seed) })
const check = new Check(chip, head)
const began = process.hrtime.bigint()
let litNs = 0
let since = null
chip.watch(PINS.gate, isHigh => {
  if (isHigh) since = chip.now
  else if (since !== null) litNs += chip.now - since
  if (!isHigh) since = null
})

const end = () => {
  const wallS = Number(process.hrtime.bigint() - began) / 1e9
  const seen = { passed_s: chip.now / 1e9, wall_s: wallS, lit_s: litNs / 1e9, ...check.summary() }
  if (report) {
    writeFileSync(`${report}.json`, `${JSON.stringify(seen, null, 2)}\n`)
    writeFileSync(`${report}.csv`, check.csv())
  }
  process.exit(0)
}
process.stdin.on('data', bytes => chip.take(bytes))
process.stdin.on('end', end)
// nobody reads any more
process.stdout.on('error', end)
process.on('SIGTERM', end)

const pass = () => {
  const said = chip.run(PIECE_NS)
  check.take(said)
  if (said.length > 0) process.stdout.write(said)
  const aheadMs = (chip.now - Number(process.hrtime.bigint() - began)) / 1e6
  if (aheadMs > 1) setTimeout(pass, aheadMs)
  else setImmediate(pass)
}
pass()
