// @ts-check
/** Asks for the unit of a drawing whose file names none. */

import { by, element } from './dom.js'
import { length, listed } from './words.js'

/** @typedef {import('./api.js').Flags} Flags */

const UNITS = /** @type {const} */ ([['mm', 1e-3], ['cm', 1e-2], ['m', 1], ['in', 0.0254], ['ft', 0.3048]])

/** Shows the question, where it is open. @param {import('./api.js').Sheet | null} sheet what was planned, if anything @param {Flags} flags @param {boolean} refused whether nothing was planned as no unit makes sense @param {(flags: Flags) => void} chosen */
export function askUnit(sheet, flags, refused, chosen) {
  const place = by('unit')
  const is_sized = [flags.unit, flags.width, flags.height].some((value) => value) || listed(flags.align).length > 1
  const is_open = (sheet?.unit_guessed ?? refused) && !is_sized
  place.hidden = !is_open
  if (!is_open) return
  const [wide, high] = sheet ? [0, 1].map((n) => 1e3 * Math.abs(sheet.corners[2][n] - sheet.corners[0][n])) : [0, 0]
  const round = (/** @type {number} */ value) => String(Number(value.toPrecision(5)))
  const words = sheet ? `This file names no unit. It is ${round(wide)} × ${round(high)} of something: what is one?` : 'This file names no unit that makes sense: what is one?'
  const buttons = UNITS.map(([name, metres]) => {
    const size = sheet ? `: ${length(wide * metres)} × ${length(high * metres)}` : ''
    const button = element('button', { type: 'button', class: 'plain' }, element('strong', { text: name }), element('span', { text: size }))
    button.addEventListener('click', () => chosen({ unit: name }))
    return button
  })
  place.replaceChildren(element('p', { text: words }), element('div', { class: 'choices' }, ...buttons))
}
