// @ts-check
/** A button, or a key, that is held for a while: so that nobody arms by chance. */

/** How long it is held, ms. */
export const HELD = 1000

export class Hold {
  /** @param {HTMLButtonElement} button @param {() => void} held when it was held long enough */
  constructor(button, held) {
    this.button = button
    this.held = held
    /** @type {number | null} */
    this.timer = null
    button.addEventListener('pointerdown', (event) => event.button === 0 && this.begin())
    for (const over of ['pointerup', 'pointerleave', 'pointercancel', 'blur']) button.addEventListener(over, () => this.cancel())
    button.addEventListener('keydown', (event) => {
      if (event.key !== ' ' && event.key !== 'Enter') return
      event.preventDefault()
      if (!event.repeat) this.begin()
    })
    button.addEventListener('keyup', () => this.cancel())
    button.addEventListener('contextmenu', (event) => event.preventDefault())
    addEventListener('blur', () => this.cancel())
  }

  begin() {
    this.cancel()
    if (this.button.disabled) return
    this.button.classList.add('held')
    this.timer = window.setTimeout(() => {
      this.cancel()
      this.held()
    }, HELD)
  }

  cancel() {
    if (this.timer !== null) clearTimeout(this.timer)
    this.timer = null
    this.button.classList.remove('held')
  }
}
