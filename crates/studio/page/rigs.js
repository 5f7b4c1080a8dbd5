// @ts-check
/** Rig files: read, written with what is wrong shown at its line, copied from presets, deleted, used. */

import * as api from './api.js'
import { fileName } from './calibrated.js'
import { by, element } from './dom.js'

/** How long what is typed rests before it is looked at, ms. */
const REST = 400
const FEW = (/** @type {string} */ base) => `# What differs from ${base}; all else is as there.\nbase = "${base}"\nname = "My head"\n\n[laser]\npower = "1mW"\n`

export class Rigs {
  /** @param {{ problem: (error: unknown) => void, use: (name: string) => void, changed: () => void, operates: boolean }} hooks */
  constructor(hooks) {
    this.hooks = hooks
    /** @type {api.Rig[]} */
    this.all = []
    this.name = ''
    this.own = false
    /** What is kept of it. */
    this.kept = ''
    /** What was written and not kept, by name. @type {Map<string, string>} */
    this.drafts = new Map()
    this.timer = 0
    this.asked = 0
    this.text = /** @type {HTMLTextAreaElement} */ (by('rig-text'))
    this.text.addEventListener('input', () => this.#typed())
    this.text.addEventListener('scroll', () => (by('rig-lines').scrollTop = this.text.scrollTop))
    by('rig-save').addEventListener('click', () => this.#save())
    by('rig-use').addEventListener('click', () => hooks.use(this.name))
    by('rig-delete').addEventListener('click', () => this.#drop())
    by('rig-few').addEventListener('click', () => this.#make(FEW))
    by('rig-copy').addEventListener('click', () => this.#make(async (base) => (await api.rig(base)).toml))
  }

  /** Shows the view, with a rig. @param {string} name */
  async show(name) {
    const wanted = decodeURIComponent(name) || this.name
    await this.#list()
    const is = this.all.some((rig) => rig.name === wanted) ? wanted : (this.all.find((rig) => rig.own)?.name ?? this.all[0].name)
    await this.#read(is)
    this.#mark()
  }

  async #list() {
    this.all = await api.rigs()
    const entry = (/** @type {api.Rig} */ rig) => element('li', {}, element('a', { href: `#rigs=${encodeURIComponent(rig.name)}`, text: `${rig.problem ? '⚠ ' : ''}${rig.name}`, title: rig.problem?.message ?? rig.description }))
    by('rig-own').replaceChildren(...this.all.filter((rig) => rig.own).map(entry))
    by('rig-none').hidden = this.all.some((rig) => rig.own)
    by('rig-presets').replaceChildren(...this.all.filter((rig) => !rig.own).map(entry))
    const base = /** @type {HTMLSelectElement} */ (by('rig-base'))
    const was = base.value
    base.replaceChildren(...this.all.filter((rig) => !rig.own).map((rig) => new Option(rig.name, rig.name)))
    if (was) base.value = was
  }

  #mark() {
    for (const link of document.querySelectorAll('#rig-own a, #rig-presets a')) {
      if (link.getAttribute('href') === `#rigs=${encodeURIComponent(this.name)}`) link.setAttribute('aria-current', 'true')
      else link.removeAttribute('aria-current')
    }
  }

  /** @param {string} name */
  async #read(name) {
    const number = ++this.asked
    const told = await api.rig(name)
    // another one was chosen since
    if (number !== this.asked) return
    this.name = told.name
    this.own = told.own
    this.kept = told.toml
    const text = this.drafts.get(name) ?? told.toml
    if (this.text.value !== text) this.text.value = text
    this.text.readOnly = !told.own || !this.hooks.operates
    this.text.scrollTop = 0
    by('rig-title').textContent = told.name
    by('rig-about').textContent = told.own ? 'A file of the studio’s folder.' : `A preset of the program: ${this.all.find((rig) => rig.name === name)?.description ?? ''}. It cannot be changed: copy it.`
    by('rig-delete').hidden = !told.own
    by('rig-save').hidden = !told.own
    this.hooks.problem(null)
    await this.#look()
  }

  /** Lines, the one that is wrong among them. @param {number | null} wrong */
  #lines(wrong) {
    const count = this.text.value.split('\n').length
    const lines = by('rig-lines')
    lines.replaceChildren(...Array.from({ length: count }, (_, n) => element('span', { text: `${n + 1}`, class: n + 1 === wrong ? 'wrong' : undefined })))
    lines.scrollTop = this.text.scrollTop
  }

  #typed() {
    this.hooks.problem(null)
    this.drafts.set(this.name, this.text.value)
    this.#lines(null)
    this.#state()
    clearTimeout(this.timer)
    this.timer = window.setTimeout(() => this.#look(), REST)
  }

  /** Whether there is something to save. */
  #state() {
    const is_changed = this.text.value !== this.kept
    by('rig-save').toggleAttribute('disabled', !is_changed || !this.hooks.operates)
    by('rig-save').textContent = is_changed ? 'Save' : 'Saved'
    // what draws is what is kept
    by('rig-use').textContent = is_changed && this.own ? 'Draw with it as saved' : 'Draw with it'
  }

  /** Looks at what is written, without keeping it. */
  async #look() {
    this.#state()
    if (!this.own || !this.hooks.operates) {
      this.#lines(null)
      by('rig-wrong').hidden = true
      return
    }
    const number = ++this.asked
    try {
      const { remarks } = await api.writeRig(this.name, this.text.value, { only_check: true })
      if (number === this.asked) this.#right(remarks)
    } catch (error) {
      if (number === this.asked) this.#wrong(error)
    }
  }

  /** @param {string[]} remarks */
  #right(remarks) {
    this.#lines(null)
    by('rig-wrong').hidden = remarks.length === 0
    by('rig-wrong').replaceChildren(...remarks.map((text) => element('p', { text })))
  }

  /** Shows what is wrong, and where: a click goes there. @param {unknown} error */
  #wrong(error) {
    if (!(error instanceof api.Refusal) || error.failure.code !== 'rig-file') return this.hooks.problem(error)
    const where = error.failure.where
    this.#lines(where?.line ?? null)
    const [words, ...shown] = error.failure.message.split('\n')
    const place = by('rig-wrong')
    place.hidden = false
    const parts = [element('strong', { text: words })]
    if (shown.length > 0) parts.push(element('pre', { text: shown.join('\n') }))
    if (where?.line) {
      const go = element('button', { type: 'button', class: 'plain', text: `Go to line ${where.line}` })
      go.addEventListener('click', () => this.#goTo(where.line, where.column))
      parts.push(go)
    }
    place.replaceChildren(...parts)
  }

  /** @param {number} line @param {number} column */
  #goTo(line, column) {
    const lines = this.text.value.split('\n')
    const at = lines.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0) + Math.max(0, (column || 1) - 1)
    this.text.focus()
    this.text.setSelectionRange(at, at)
    const high = this.text.scrollHeight / Math.max(1, lines.length)
    this.text.scrollTop = Math.max(0, (line - 6) * high)
  }

  async #save() {
    const { name } = this
    const text = this.text.value
    by('rig-save').setAttribute('disabled', '')
    try {
      await api.writeRig(name, text, { before: this.kept })
      // what was typed meanwhile is a draft still
      if (this.drafts.get(name) === text) this.drafts.delete(name)
      if (this.name === name) this.kept = text
      await this.#list()
      this.#mark()
      this.hooks.changed()
    } catch (error) {
      if (this.name === name && error instanceof api.Refusal && error.failure.code === 'busy') this.#other(error)
      else if (this.name === name) this.#wrong(error)
    }
    this.#state()
  }

  /** Somebody else has changed it: asks whose text is kept. @param {api.Refusal} error */
  #other(error) {
    const { name } = this
    const act = (/** @type {string} */ text, /** @type {() => Promise<void>} */ does) => {
      const button = element('button', { type: 'button', class: 'plain', text })
      button.addEventListener('click', () => does().catch(this.hooks.problem))
      return button
    }
    const theirs = act('Read theirs, drop mine', async () => {
      this.drafts.delete(name)
      await this.#read(name)
    })
    const mine = act('Keep mine in its place', async () => {
      this.kept = (await api.rig(name)).toml
      await this.#save()
    })
    by('rig-wrong').hidden = false
    by('rig-wrong').replaceChildren(element('strong', { text: error.failure.message.split(':')[0] }), element('div', { class: 'two' }, theirs, mine))
  }

  /** A new file, of a preset. @param {(base: string) => string | Promise<string>} text */
  async #make(text) {
    const field = /** @type {HTMLInputElement} */ (by('rig-name'))
    const stem = fileName(field.value, 'my-head').replace(/\.toml$/, '')
    this.hooks.problem(null)
    const free = (/** @type {string} */ name) => !this.all.some((rig) => rig.name === name)
    let name = `${stem}.toml`
    for (let n = 2; !free(name); n++) name = `${stem}-${n}.toml`
    try {
      await api.writeRig(name, await text(/** @type {HTMLSelectElement} */ (by('rig-base')).value), { before: '' })
      field.value = ''
      this.hooks.problem(null)
      this.hooks.changed()
      const address = `#rigs=${encodeURIComponent(name)}`
      if (location.hash === address) await this.show(name)
      else location.hash = address
    } catch (error) {
      this.hooks.problem(error)
    }
  }

  async #drop() {
    try {
      const { name } = this
      const trash = await api.discard('rigs', name)
      this.name = ''
      this.drafts.delete(name)
      this.hooks.changed()
      await this.show('')
      const undo = element('button', { type: 'button', class: 'plain', text: 'Undo' })
      undo.addEventListener('click', () => api.restore('rigs', trash).then(() => this.hooks.changed()).then(() => this.show(name)).catch(this.hooks.problem))
      by('rig-wrong').hidden = false
      by('rig-wrong').replaceChildren(element('span', { text: `${name} is in the trash of the studio’s folder. ` }), undo)
    } catch (error) {
      this.hooks.problem(error)
    }
  }
}
