// @ts-check
/** Pictures and drawings: the strip of those that there are, taking one in, deleting one. */

import * as api from './api.js'
import { by, element } from './dom.js'

/** Most that are shown. */
const MOST = 40

export class Pictures {
  /** @param {{ choose: (picture: string) => void, chosen: () => string, problem: (error: unknown) => void, operates: boolean }} hooks what is put on the wall, and what is there */
  constructor(hooks) {
    this.hooks = hooks
    by('open').addEventListener('click', () => by('file').click())
    by('file').addEventListener('change', () => {
      const input = /** @type {HTMLInputElement} */ (by('file'))
      this.take(input.files?.[0])
      // the same file may be taken again once it was changed
      input.value = ''
    })
    addEventListener('paste', (event) => this.take(event.clipboardData?.files[0]))
    addEventListener('dragover', (event) => event.preventDefault())
    addEventListener('drop', (event) => {
      event.preventDefault()
      this.take(event.dataTransfer?.files[0])
    })
  }

  /** Takes a file in. @param {File | null | undefined} file */
  async take(file) {
    if (!file || !this.hooks.operates) return
    try {
      const picture = await api.add(file)
      await this.list()
      this.hooks.choose(picture)
    } catch (error) {
      this.hooks.problem(error)
    }
  }

  async list() {
    const all = await api.pictures()
    by('pictures').replaceChildren(
      ...all.slice(0, MOST).map((picture) => {
        const button = element('button', { type: 'button', class: 'picture', title: picture.id, 'aria-pressed': 'false' })
        button.append(picture.shows ? element('img', { src: api.pictureUrl(picture.id), alt: '', loading: 'lazy' }) : element('span', { class: 'kind', text: picture.id.split('.').pop() }), element('span', { text: picture.id }))
        button.addEventListener('click', () => this.hooks.choose(picture.id))
        if (picture.example || !this.hooks.operates) return element('li', {}, button)
        const away = element('button', { type: 'button', class: 'away', text: '×', title: 'Delete', 'aria-label': `Delete ${picture.id}` })
        away.addEventListener('click', () => this.#drop(picture.id))
        return element('li', { class: 'given' }, button, away)
      }),
    )
    this.mark(this.hooks.chosen())
  }

  /** Marks the one that is on the wall, and brings it into view. @param {string} chosen */
  mark(chosen) {
    for (const button of by('pictures').querySelectorAll('button.picture')) {
      const is = /** @type {HTMLElement} */ (button).title === chosen
      button.setAttribute('aria-pressed', String(is))
      const strip = by('pictures')
      if (is && strip.clientWidth > 0) strip.scrollLeft = Math.max(0, /** @type {HTMLElement} */ (button).offsetLeft - strip.offsetLeft - strip.clientWidth / 2)
    }
  }

  /** Deletes a picture; the one on the wall gives way to the house. @param {string} id */
  async #drop(id) {
    try {
      const name = await api.discard('pictures', id)
      await this.list()
      if (this.hooks.chosen() === id) this.hooks.choose('house.png')
      const undo = element('button', { type: 'button', class: 'plain', text: 'Undo' })
      undo.addEventListener('click', () => api.restore('pictures', name).then(() => this.list()).then(() => this.hooks.problem(null), this.hooks.problem))
      by('problem').hidden = false
      by('problem').replaceChildren(element('span', { text: `${id} is in the trash of the studio’s folder. ` }), undo)
    } catch (error) {
      this.hooks.problem(error)
    }
  }
}
