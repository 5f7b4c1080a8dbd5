// @ts-check
/** What the page shows now, who is told when it changes, and what was before. */

/**
 * @typedef {import('./api.js').Flags} Flags
 * @typedef {{ picture: string, flags: Flags }} Asked what is to be planned
 */

const MOST_STEPS = 200

export class Store {
  /** @param {Asked} asked */
  constructor(asked) {
    this.asked = asked
    /** @type {Asked[]} */
    this.before = []
    /** @type {Asked[]} */
    this.after = []
    /** @type {((asked: Asked) => void)[]} */
    this.listeners = []
  }

  /** @param {(asked: Asked) => void} listener */
  watch(listener) {
    this.listeners.push(listener)
  }

  /** Takes another wish; the one before can be had back. @param {Partial<Asked>} change */
  set(change) {
    const next = { ...this.asked, ...change }
    if (JSON.stringify(next) === JSON.stringify(this.asked)) return
    this.before.push(this.asked)
    if (this.before.length > MOST_STEPS) this.before.shift()
    this.after = []
    this.#take(next)
  }

  /** One flag, or several. @param {Flags} flags */
  flags(flags) {
    this.set({ flags: { ...this.asked.flags, ...flags } })
  }

  undo() {
    const before = this.before.pop()
    if (!before) return
    this.after.push(this.asked)
    this.#take(before)
  }

  redo() {
    const after = this.after.pop()
    if (!after) return
    this.before.push(this.asked)
    this.#take(after)
  }

  /** @param {Asked} asked */
  #take(asked) {
    this.asked = asked
    for (const listener of this.listeners) listener(asked)
  }
}

/** Flags without what is left out of a command, in one order. @param {Flags} flags */
export const essence = (flags) => JSON.stringify(Object.entries(flags).filter(([, value]) => value !== false && value !== null && value.toString() !== '').sort())
