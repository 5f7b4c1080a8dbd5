// @ts-check
/** Devices of the network: which have joined, and how one is invited. */

import * as api from './api.js'
import { by, element } from './dom.js'

/** How often the list is looked at while it is shown, ms. */
const LOOK = 2000

export class Devices {
  /** @param {(error: unknown) => void} problem */
  constructor(problem) {
    this.problem = problem
    this.timer = 0
    this.count = Infinity
    this.own = 0
    by('invite-operator').addEventListener('click', () => this.#invite('operator'))
    by('invite-viewer').addEventListener('click', () => this.#invite('viewer'))
  }

  /** Shows the view, and keeps it true; or leaves it. @param {boolean} is */
  show(is) {
    clearInterval(this.timer)
    if (!is) {
      // nobody else reads it once the view is left
      by('invitation').hidden = true
      return
    }
    this.#look()
    this.timer = window.setInterval(() => this.#look(), LOOK)
  }

  async #look() {
    try {
      const session = await api.session()
      this.problem(null)
      const { lan, devices } = session
      this.own = session.device
      by('inviting').hidden = !lan
      by('devices-words').textContent = lan
        ? `A phone at the wall, or another computer of this network, finds the studio at ${lan.addresses.join(' or ')}. Only devices that were invited may ask anything; any device may stop.`
        : session.role === 'operator'
          ? 'No other device reaches this studio now. Close it, and start it with tracelight studio --lan: then a phone that you invite here operates it at the wall.'
          : 'This device looks on, and may stop.'
      const count = (devices ?? []).length
      // what was shown is used up
      if (count > this.count) by('invitation').hidden = true
      this.count = count
      by('nobody').hidden = count > 0
      by('device-list').replaceChildren(...(devices ?? []).map((device) => this.#row(device)))
    } catch (error) {
      this.problem(error)
    }
  }

  /** @param {api.Device} device */
  #row(device) {
    const minutes = Math.floor(device.seen_s / 60)
    const here = device.lines > 0 ? 'attends a job now' : minutes < 1 ? 'seen just now' : `seen ${minutes} min ago`
    const button = element('button', { type: 'button', class: 'plain', text: 'Remove', 'aria-label': `Remove: ${device.name}` })
    button.addEventListener('click', async () => {
      await api.sendAway(device.id).catch(this.problem)
      this.#look()
    })
    const role = device.role === 'operator' ? 'may operate' : 'looks on'
    return element('li', {}, element('div', {}, element('strong', { text: device.id === this.own ? `${device.name}: this device` : device.name }), element('p', { class: 'under', text: `${role} · ${here}` })), button)
  }

  /** @param {'operator' | 'viewer'} role */
  async #invite(role) {
    try {
      const made = await api.invite(role)
      this.problem(null)
      by('invitation').hidden = false
      by('invited').textContent = role === 'operator' ? 'For a device that may operate the head' : 'For a device that looks on, and may stop'
      const code = /** @type {HTMLImageElement} */ (by('code'))
      code.hidden = made.code_svg === null
      code.src = `data:image/svg+xml,${encodeURIComponent(made.code_svg ?? '')}`
      by('link').textContent = made.links[0]
      by('fingerprint').textContent = made.fingerprint
      by('invitation').scrollIntoView({ block: 'nearest' })
    } catch (error) {
      this.problem(error)
    }
  }
}
