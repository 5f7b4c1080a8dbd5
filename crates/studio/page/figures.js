// @ts-check
/** What of a plan people read: how large it is, how long it takes, its strokes, its command. */

import { by, element } from './dom.js'
import { length, plain, time } from './words.js'

/** There is no plan. */
export function noFigures() {
  for (const id of ['size', 'count', 'length', 'duration', 'spot']) by(id).textContent = '–'
  by('command').textContent = ''
  by('strokes').replaceChildren()
}

/** How large it is, and how long it takes. @param {import('./api.js').Plan} made */
export function figures(made) {
  by('command').textContent = made.command
  const { target, strokes, plan: timed, head } = made.plan
  by('size').textContent = `${length(target.width_m)} × ${length(target.height_m)}`
  by('count').textContent = String(strokes.count)
  by('length').textContent = length(strokes.length_m)
  by('duration').textContent = time(timed.duration_s)
  by('spot').textContent = `${plain(head.spot_mm, 1)} mm wide`
  by('strokes').replaceChildren(...made.plan.sequence.slice(0, 500).map(row))
}

/** @param {import('./api.js').Stroke} stroke */
function row(stroke) {
  const cells = [String(stroke.number), length(stroke.length_m), time(stroke.lit_from_s), time(stroke.lit_to_s - stroke.lit_from_s)]
  return element('tr', {}, ...cells.map((text) => element('td', { text })))
}
