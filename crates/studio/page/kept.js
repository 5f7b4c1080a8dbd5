// @ts-check
/** What this browser keeps between visits: how it looks, and what was asked for last. */

const THEMES = /** @type {const} */ ([['auto', '◐ Auto'], ['light', '○ Light'], ['dark', '● Dark'], ['room', '◍ Dark room']])

/** Keeps a text in this browser; one that keeps nothing begins anew. @param {'localStorage' | 'sessionStorage'} where @param {string} name @param {string} text */
export function keep(where, name, text) {
  try {
    window[where].setItem(name, text)
  } catch {
    // it is shown all the same
  }
}

/** What this browser has kept; null where it has nothing. @param {'localStorage' | 'sessionStorage'} where @param {string} name */
export function kept(where, name) {
  try {
    return window[where].getItem(name)
  } catch {
    return null
  }
}

/** Lets a button change between grounds. @param {HTMLElement} button @param {() => void} changed */
export function themes(button, changed) {
  const take = (/** @type {string | null} */ name) => {
    const [known, label] = THEMES[Math.max(0, THEMES.findIndex(([known]) => known === name))]
    document.documentElement.dataset.theme = known
    button.textContent = label
    keep('localStorage', 'theme', known)
    changed()
  }
  button.addEventListener('click', () => {
    const at = THEMES.findIndex(([name]) => name === document.documentElement.dataset.theme)
    take(THEMES[(at + 1) % THEMES.length][0])
  })
  take(kept('localStorage', 'theme'))
}

/** Lets a button change between centimetres and inches. @param {HTMLElement} button @param {(imperial: boolean) => void} changed */
export function units(button, changed) {
  const take = (/** @type {boolean} */ imperial) => {
    button.textContent = imperial ? 'in' : 'cm'
    button.title = imperial ? 'Lengths are in inches and feet: change to metres' : 'Lengths are in metres: change to inches'
    button.setAttribute('aria-label', imperial ? 'in: inches and feet' : 'cm: metres')
    keep('localStorage', 'units', imperial ? 'in' : 'm')
    changed(imperial)
  }
  button.addEventListener('click', () => take(kept('localStorage', 'units') !== 'in'))
  take(kept('localStorage', 'units') === 'in')
}
