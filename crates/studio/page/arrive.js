// @ts-check
/** A page arrives: it joins where it is invited, and learns what it may do. */

import * as api from './api.js'
import { by } from './dom.js'

/** Joins by the invitation in the address, if there is one, and tells who this page is then. @returns {Promise<api.Session>} */
export async function arrive() {
  const invitation = new URLSearchParams(location.hash.slice(1)).get('join')
  if (invitation) {
    // what is used once is nobody's to see or to go back to
    history.replaceState(null, '', location.pathname)
    try {
      await api.join(invitation, deviceName())
    } catch (error) {
      by('outside-why').textContent = error instanceof api.Refusal ? error.failure.message : String(error)
    }
  }
  return api.session()
}

/** What a device calls itself, as far as its browser tells. */
function deviceName() {
  const agent = navigator.userAgent
  const found = ['iPhone', 'iPad', 'Android', 'Windows', 'Macintosh', 'CrOS', 'Linux'].find((name) => agent.includes(name)) ?? 'device'
  const browser = ['Firefox', 'Edg', 'Chrome', 'Safari'].find((name) => agent.includes(name))
  return [found.replace('Macintosh', 'Mac').replace('CrOS', 'Chromebook'), browser?.replace('Edg', 'Edge')].filter(Boolean).join(', ')
}
