// @ts-check
/** What a calibration is worth, and what was found by one, in words. */

import { element } from './dom.js'
import { plain } from './words.js'

/** @typedef {import('./api.js').Calibration} Calibration */

/** After how many days a calibration is not to be trusted without a look: cameras are moved. */
const OLD_DAYS = 1
/** What a verdict means. @type {Record<string, string>} */
const VERDICTS = { great: 'Great', usable: 'Usable', poor: 'Poor' }

/** How good a calibration is, in words. @param {Calibration} of */
export function verdict(of) {
  if (of.problem) return `⚠ ${of.problem.message}`
  const off = of.off_mm == null ? (of.of === 'lens' ? 'lens alone' : 'how far it is off is not known') : `${VERDICTS[of.verdict ?? ''] ?? ''}: off by ${plain(of.off_mm, 2)} mm, rms`
  const days = Math.floor((Date.now() - Date.parse(of.date)) / 86_400_000)
  const age = days < 1 ? 'of today' : days === 1 ? 'of yesterday' : `${days} days old`
  return `${off} · ${age}${days > OLD_DAYS ? ' · ⚠ look whether it holds' : ''}`
}

/** A name as a file has it. @param {string} name @param {string} otherwise */
export function fileName(name, otherwise) {
  const plainly = name.trim().replace(/\.toml$/i, '').replace(/[^\w-]+/g, '-').replace(/^-+|-+$/g, '')
  return `${plainly || otherwise}.toml`
}

/** Tells what was found. @param {HTMLElement} place @param {import('./calibrations.js').Calibrated} made */
export function tell(place, made) {
  const { calibration, remarks, words, command, replaced } = made
  const title = `${calibration.name}: ${verdict(calibration)}`
  const more = [...remarks, ...(replaced ? [`What had that name before lies in the folder’s trash as ${replaced}.`] : [])]
  place.classList.toggle('failed', calibration.verdict === 'poor')
  place.replaceChildren(element('h2', { text: title }), element('pre', { text: words, tabindex: '0', role: 'region', 'aria-label': 'What was found' }), element('ul', { class: 'remarks' }, ...more.map((remark) => element('li', { text: remark }))), element('code', { text: command }))
  place.hidden = false
}
