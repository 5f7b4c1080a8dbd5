// @ts-check
/** A picture taken by a camera of the device on which the page is: a webcam, a phone's. */

import { by } from './dom.js'

/** As large as is asked for, pixels; a camera that has less gives that. */
const WIDE = 1920

export class Camera {
  /** @param {{ take: (file: File) => void, problem: (error: unknown) => void }} hooks */
  constructor(hooks) {
    this.hooks = hooks
    /** @type {MediaStream | null} */
    this.stream = null
    /** Which opening is meant: others were closed. */
    this.opening = 0
    this.video = /** @type {HTMLVideoElement} */ (by('video'))
    this.which = /** @type {HTMLSelectElement} */ (by('which-camera'))
    by('take-picture').addEventListener('click', () => this.#take())
    by('close-camera').addEventListener('click', () => this.close())
    this.which.addEventListener('change', () => this.open(this.which.value))
    // nobody is filmed who has left
    addEventListener('hashchange', () => this.close())
    addEventListener('pagehide', () => this.close())
  }

  /** Shows what a camera sees: that one, or the one behind a phone. @param {string} [id] */
  async open(id) {
    this.close()
    const opening = this.opening
    if (!navigator.mediaDevices) return this.hooks.problem(new Error('a browser gives its camera to pages of this computer and to those that come by https: open the studio so, or open a photograph'))
    try {
      const wanted = id ? { deviceId: { exact: id } } : { facingMode: 'environment' }
      const stream = await navigator.mediaDevices.getUserMedia({ video: { ...wanted, width: { ideal: WIDE } } })
      // it was closed, or opened again, while somebody thought about it
      if (opening !== this.opening) return stream.getTracks().forEach((track) => track.stop())
      this.stream = stream
      this.video.srcObject = stream
      await this.video.play()
      const all = (await navigator.mediaDevices.enumerateDevices()).filter(({ kind }) => kind === 'videoinput')
      if (opening !== this.opening) return
      const used = stream.getVideoTracks()[0]?.getSettings().deviceId
      this.which.replaceChildren(...all.map(({ deviceId, label }, n) => new Option(label || `Camera ${n + 1}`, deviceId, false, deviceId === used)))
      this.which.hidden = all.length < 2
      by('camera').hidden = false
      by('camera').scrollIntoView({ block: 'nearest' })
      this.hooks.problem(null)
    } catch (error) {
      if (opening !== this.opening) return
      this.close()
      this.hooks.problem(new Error(told(error)))
    }
  }

  close() {
    this.opening++
    this.stream?.getTracks().forEach((track) => track.stop())
    this.stream = null
    this.video.srcObject = null
    by('camera').hidden = true
  }

  #take() {
    const canvas = document.createElement('canvas')
    canvas.width = this.video.videoWidth
    canvas.height = this.video.videoHeight
    canvas.getContext('2d')?.drawImage(this.video, 0, 0)
    canvas.toBlob((blob) => {
      this.close()
      if (blob) this.hooks.take(new File([blob], 'camera.png', { type: 'image/png' }))
    })
  }
}

/** Why there is no image, in words. @param {unknown} error */
function told(error) {
  const name = error instanceof DOMException ? error.name : ''
  if (name === 'NotAllowedError') return 'this page may not use a camera: allow it beside the address, or open a photograph'
  if (name === 'NotFoundError' || name === 'OverconstrainedError') return 'this device has no such camera: connect one, or open a photograph'
  if (name === 'NotReadableError') return 'another program uses the camera: close it, or open a photograph'
  return `the camera gives no image: ${error instanceof Error ? error.message : String(error)}`
}
