// Where the light of the emulated board's head really was, beside the same drawing on the simulated rig: no further from the plan than that and some more.
//
//     node drawn.mjs RUN REPORT SIMULATED_RUN

import { readFileSync } from 'node:fs'

const [run, report, simulated] = process.argv.slice(2)
// The board's law takes some of a tick, and its bridges switch when they do, mm.
const MORE_MM = 0.02

const table = path => {
  const [head, ...lines] = readFileSync(path, 'utf8').trim().split('\n').map(line => line.split(','))
  return lines.map(line => Object.fromEntries(head.map((name, n) => [name, line[n]])))
}
const furthest = spots => spots.reduce((most, [x, y, planX, planY]) => Math.max(most, 1000 * Math.hypot(x - planX, y - planY)), 0)

const rows = table(`${run}/trace.csv`).filter(row => row.plan_x_m)
const plan = new Map(rows.map(row => [row.plan_tick, [Number(row.plan_x_m), Number(row.plan_y_m)]]))
const light = table(`${report}.csv`).filter(row => row.light === '1' && plan.has(row.plan_tick))
const here = furthest(light.map(row => [Number(row.x_m), Number(row.y_m), ...plan.get(row.plan_tick)]))
const lit = table(`${simulated}/trace.csv`).filter(row => row.laser === '1' && row.plan_x_m)
const there = furthest(lit.map(row => [row.x_m, row.y_m, row.plan_x_m, row.plan_y_m].map(Number)))
const seen = JSON.parse(readFileSync(`${report}.json`))

console.log(`${light.length} ms of light, ${here.toFixed(3)} mm off at most; ${there.toFixed(3)} mm on the simulated rig`)
console.log(`${seen.ticks} ticks, ${seen.stamps} stamps: ${seen.counts_wrong} counts wrong, ${seen.stamps_missing} stamps missing, ${seen.stamps_off_us.toFixed(3)} µs off at most`)
const isDrawn = light.length > 0.9 * lit.length
if (!isDrawn || here > there + MORE_MM || seen.counts_wrong > 0 || seen.stamps_missing > 0 || seen.stamps_off_us > 0.2) {
  console.error('that is not what was to be drawn')
  process.exit(1)
}
