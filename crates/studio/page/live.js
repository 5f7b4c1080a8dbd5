// @ts-check
/** The line to a job that is attended: what happens comes, wishes and signs of life go. */

/**
 * @typedef {{ event: string, [key: string]: any }} Told
 */

/** How often the page says that it is there, ms: a second without it pauses the job. */
const HERE = 350
/** How soon a line that broke is tried again, ms. */
const AGAIN = 500

export class Live {
  /** @param {string} page @param {(told: Told) => void} told @param {(open: boolean) => void} opened */
  constructor(page, told, opened) {
    this.page = page
    this.told = told
    this.opened = opened
    /** @type {WebSocket | null} */
    this.socket = null
    this.wanted = false
    this.operates = false
    setInterval(() => this.operates && this.#say({ here: true }), HERE)
  }

  /** Listens from now on. */
  open() {
    if (this.wanted) return
    this.wanted = true
    this.#connect()
  }

  /** Listens no more. */
  close() {
    this.wanted = false
    this.socket?.close()
  }

  /** Asks something of the job. @param {string} wish @returns {boolean} whether it could be sent */
  wish(wish) {
    return this.#say({ wish })
  }

  #connect() {
    const socket = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/api/v1/live?page=${this.page}`)
    this.socket = socket
    socket.onopen = () => this.opened(true)
    socket.onmessage = (message) => this.told(JSON.parse(message.data))
    socket.onclose = () => {
      this.opened(false)
      if (this.socket === socket) this.socket = null
      if (this.wanted) setTimeout(() => this.wanted && !this.socket && this.#connect(), AGAIN)
    }
  }

  /** @param {unknown} what */
  #say(what) {
    if (this.socket?.readyState !== WebSocket.OPEN) return false
    this.socket.send(JSON.stringify(what))
    return true
  }
}
