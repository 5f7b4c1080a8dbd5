// @ts-check
/** The head at a port, moved by hand: jogged, told that it points straight ahead, taken there. Always dark. */

import * as api from './api.js'
import { by } from './dom.js'
import { plain } from './words.js'

export class HeadPad {
  /** @param {(error: unknown) => void} problem */
  constructor(problem) {
    this.problem = problem
    this.moves = false
    for (const button of by('head').querySelectorAll('[data-jog]')) {
      const way = (/** @type {HTMLElement} */ (button).dataset.jog ?? '0,0').split(',').map(Number)
      button.addEventListener('click', () => {
        const step = Number(/** @type {HTMLSelectElement} */ (by('jog-by')).value)
        const [pan, tilt] = way.map((one) => plain(one * step, 2))
        this.#move({ move: 'jog', by: `${pan}deg,${tilt}deg` })
      })
    }
    by('home').addEventListener('click', () => this.#move({ move: 'home' }))
    by('park').addEventListener('click', () => this.#move({ move: 'park' }))
    by('head').addEventListener('toggle', () => /** @type {HTMLDetailsElement} */ (by('head')).open && this.#move({ move: 'look' }))
  }

  /** Shows it where there is a head to move. @param {boolean} is */
  show(is) {
    by('head').hidden = !is
  }

  /** @param {{ move: string, by?: string }} asked */
  async #move(asked) {
    if (this.moves) return
    this.#busy(true)
    try {
      const at = await api.moveHead(asked)
      this.problem(null)
      const where = `pan ${plain(at.pan_deg, 2)}°, tilt ${plain(at.tilt_deg, 2)}°`
      by('head-at').textContent = at.homed ? `It knows where it points: ${where}.` : `It does not know where it points; it counts ${where}. Turn it until it points straight ahead, and tell it.`
    } catch (error) {
      this.problem(error)
    } finally {
      this.#busy(false)
    }
  }

  /** @param {boolean} is */
  #busy(is) {
    this.moves = is
    for (const button of by('head').querySelectorAll('button')) button.toggleAttribute('disabled', is)
  }
}
