// @ts-check
/** The wall's grid and its rulers, in the units that somebody reads. */

import { tidy } from './paint.js'
import { shown } from './words.js'

/**
 * @typedef {import('./paint.js').Colours} Colours
 * @typedef {import('./wall.js').Wall} Wall
 */

/** Pixels of a ruler. */
export const RULER = 26
/** Pixels between two lines, at least. */
const APART = 80
const INCH_M = 0.0254
/** Steps of a ruler in inches; below and above they go by tens. */
const INCHES = [0.125, 0.25, 0.5, 1, 2, 3, 6, 12, 24, 60, 120, 240, 600, 1200]

/** How far lines are apart, m, and how a place is called there. @param {number} scale pixels a metre @returns {{ step: number, unit: string, name: (m: number) => string }} */
function steps(scale) {
  const least = APART / scale
  if (shown.imperial) {
    const inches = INCHES.find((inches) => inches * INCH_M >= least) ?? tidy(least / INCH_M)
    const step = least < INCHES[0] * INCH_M ? tidy(least / INCH_M) : inches
    const by = step >= 12 && step % 12 === 0 ? 12 : 1
    return { step: step * INCH_M, unit: by === 12 ? 'ft' : 'in', name: (m) => String(Number((m / INCH_M / by).toFixed(3))) }
  }
  const step = tidy(least)
  const [unit, a_metre] = step >= 0.5 ? ['m', 1] : step >= 0.005 ? ['cm', 100] : ['mm', 1000]
  return { step, unit, name: (m) => String(Number((m * a_metre).toFixed(3))) }
}

/** @param {CanvasRenderingContext2D} context @param {Wall} wall @param {Colours} colours */
export function drawGrid(context, wall, colours) {
  const { clientWidth: wide, clientHeight: high } = wall.canvas
  context.fillStyle = colours.wall
  context.fillRect(0, 0, wide, high)
  const { step } = steps(wall.view.scale)
  const [left, top] = wall.toPlace([0, 0])
  const [right, low] = wall.toPlace([wide, high])
  context.strokeStyle = colours.grid
  context.lineWidth = 1
  context.beginPath()
  for (let n = Math.ceil(left / step); n * step <= right; n++) {
    const [x] = wall.toPixels([n * step, 0])
    context.moveTo(Math.round(x) + 0.5, 0)
    context.lineTo(Math.round(x) + 0.5, high)
  }
  for (let n = Math.ceil(low / step); n * step <= top; n++) {
    const [, y] = wall.toPixels([0, n * step])
    context.moveTo(0, Math.round(y) + 0.5)
    context.lineTo(wide, Math.round(y) + 0.5)
  }
  context.stroke()
}

/** @param {CanvasRenderingContext2D} context @param {Wall} wall @param {Colours} colours */
export function drawRulers(context, wall, colours) {
  const { clientWidth: wide, clientHeight: high } = wall.canvas
  context.fillStyle = colours.card
  context.fillRect(0, 0, wide, RULER)
  context.fillRect(0, 0, RULER, high)
  context.strokeStyle = colours.rule
  context.lineWidth = 1
  context.strokeRect(RULER - 0.5, RULER - 0.5, wide, high)
  context.fillStyle = colours.soft
  context.font = '11px system-ui, sans-serif'
  context.textBaseline = 'middle'
  context.textAlign = 'center'
  const { step, unit, name } = steps(wall.view.scale)
  const [left, top] = wall.toPlace([RULER, RULER])
  const [right, low] = wall.toPlace([wide, high])
  for (let n = Math.ceil(left / step); n * step <= right; n++) {
    const [x] = wall.toPixels([n * step, 0])
    if (x > RULER + 14) context.fillText(name(n * step), x, RULER / 2)
  }
  for (let n = Math.ceil(low / step); n * step <= top; n++) {
    const [, y] = wall.toPixels([0, n * step])
    if (y < RULER + 14) continue
    context.save()
    context.translate(RULER / 2, y)
    context.rotate(-Math.PI / 2)
    context.fillText(name(n * step), 0, 0)
    context.restore()
  }
  context.fillText(unit, RULER / 2, RULER / 2)
}
