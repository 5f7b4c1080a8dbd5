// @ts-check
/** The head found without a camera: from the angles at which its dot is on the corners of a rectangle. */

import * as api from './api.js'
import * as asks from './calibrations.js'
import { fileName, tell } from './calibrated.js'
import { by, element } from './dom.js'

/** Corners, in the order in which somebody goes round: name, flag, where it is in the picture. @type {[string, string, number, number][]} */
const CORNERS = [['Bottom left', 'bottom_left', 60, 190], ['Bottom right', 'bottom_right', 340, 190], ['Top right', 'top_right', 340, 50], ['Top left', 'top_left', 60, 50]]
/** Angles there, as examples: pan is positive to the left, tilt downwards. */
const SUCH_AS = ['21.3deg,12.9deg', '-21.3deg,12.9deg', '-21.3deg,-12.9deg', '21.3deg,-12.9deg']
const SVG = 'http://www.w3.org/2000/svg'

/** @param {string} id */
const field = (id) => /** @type {HTMLInputElement} */ (by(id))

export class HeadCorners {
  /** @param {{ problem: (error: unknown) => void, made: (name: string) => void, operates: boolean }} hooks */
  constructor(hooks) {
    this.hooks = hooks
    const rows = CORNERS.map(([name, flag], n) => {
      const input = element('input', { type: 'text', id: `at-${flag}`, placeholder: SUCH_AS[n], spellcheck: 'false' })
      input.addEventListener('focus', () => this.#light(flag))
      const take = element('button', { type: 'button', class: 'plain take', text: 'Here', 'aria-label': `${name}: where the head points now`, hidden: 'hidden' })
      take.addEventListener('click', () => this.#take(input))
      return element('label', { class: 'row' }, element('span', { text: name }), element('span', { class: 'with-take' }, input, take))
    })
    by('corner-rows').replaceChildren(...rows)
    by('corners-simulate').addEventListener('change', () => this.#simulates())
    by('find-corners').addEventListener('click', () => this.#find())
    by('corners-picture').replaceChildren(diagram())
  }

  /** @param {boolean} is */
  async show(is) {
    by('corners-steps').hidden = by('corners-picture').hidden = !is
    by('corners-found').hidden = true
    if (!is) return
    const head = (await api.about().catch(() => null))?.head
    for (const button of document.querySelectorAll('.take')) /** @type {HTMLElement} */ (button).hidden = !head?.at_port
    this.#simulates()
  }

  /** Angles are somebody's, or simulated. */
  #simulates() {
    by('corner-rows').hidden = field('corners-simulate').checked
  }

  /** Shows which corner is meant. @param {string} flag */
  #light(flag) {
    for (const dot of document.querySelectorAll('#corners-picture [data-corner]')) dot.classList.toggle('is', dot.getAttribute('data-corner') === flag)
  }

  /** Takes the angles at which the head at the port stands now. @param {HTMLElement} input */
  async #take(input) {
    try {
      const { pan_deg, tilt_deg } = await api.moveHead({ move: 'look' })
      const at = /** @type {HTMLInputElement} */ (input)
      at.value = `${pan_deg.toFixed(3)}deg,${tilt_deg.toFixed(3)}deg`
    } catch (error) {
      this.hooks.problem(error)
    }
  }

  async #find() {
    const simulate = field('corners-simulate').checked
    /** @type {api.Flags} */
    const flags = { size: `${field('corners-width').value.trim()},${field('corners-height').value.trim()}` }
    const rig = /** @type {HTMLSelectElement} */ (document.querySelector('#fields select[name=rig]'))?.value
    if (rig) flags.rig = rig
    if (simulate) flags.simulate = true
    else for (const [, flag] of CORNERS) flags[flag] = field(`at-${flag}`).value.trim()
    by('find-corners').setAttribute('disabled', '')
    try {
      const made = await asks.calibrate({ of: 'corners', name: fileName(field('corners-name').value, 'head'), flags })
      this.hooks.problem(null)
      tell(by('corners-found'), made)
      by('corners-found').scrollIntoView({ block: 'nearest' })
      this.hooks.made(made.calibration.name)
    } catch (error) {
      by('corners-found').hidden = true
      this.hooks.problem(error)
    }
    by('find-corners').removeAttribute('disabled')
  }
}

/** The rectangle, its corners, and a head before it. */
function diagram() {
  const make = (/** @type {string} */ name, /** @type {Record<string, string>} */ how, text = '') => {
    const made = document.createElementNS(SVG, name)
    for (const [key, value] of Object.entries(how)) made.setAttribute(key, value)
    made.textContent = text
    return made
  }
  const svg = make('svg', { viewBox: '0 0 400 300', role: 'img', 'aria-label': 'A rectangle on the wall and its four corners, a head before it' })
  svg.append(make('rect', { x: '60', y: '50', width: '280', height: '140', class: 'edge' }), make('text', { x: '200', y: '38', 'text-anchor': 'middle' }, 'width'), make('text', { x: '30', y: '124', 'text-anchor': 'middle' }, 'height'))
  for (const [name, flag, x, y] of CORNERS) {
    svg.append(make('line', { x1: '200', y1: '268', x2: String(x), y2: String(y), class: 'beam' }), make('circle', { cx: String(x), cy: String(y), r: '7', 'data-corner': flag }))
    svg.append(make('text', { x: String(x), y: String(y > 100 ? y + 24 : y - 14), 'text-anchor': x < 200 ? 'start' : 'end', dx: x < 200 ? '-12' : '12' }, name))
  }
  svg.append(make('rect', { x: '182', y: '264', width: '36', height: '20', rx: '4', class: 'head' }), make('text', { x: '228', y: '280' }, 'the head'))
  return svg
}
