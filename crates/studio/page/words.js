// @ts-check
/** What people read: lengths, times, and what they type. */

/** Metres of the units that the program reads. */
const UNITS = { m: 1, cm: 0.01, mm: 0.001, in: 0.0254, '"': 0.0254, ft: 0.3048, "'": 0.3048 }

/** In which units lengths are shown, and written where the page writes one. */
export const shown = { imperial: false }

/** A length as typed, such as 3m or 24 in; null of what is none. @param {string} text @returns {number | null} */
export function metres(text) {
  const found = /^\s*([+-]?[0-9]*[.,]?[0-9]+)\s*(mm|cm|m|in|ft|"|')?\s*$/.exec(text)
  if (!found) return null
  const unit = /** @type {keyof UNITS} */ (found[2] ?? 'm')
  return Number(found[1].replace(',', '.')) * UNITS[unit]
}

/** Two lengths as typed, such as 10cm,-2in; null of what is none. @param {string} text @returns {[number, number] | null} */
export function offset(text) {
  if (text.trim() === '') return [0, 0]
  const parts = text.split(/,(?![0-9]+\s*(?:mm|cm|m|in|ft)?\s*,)/)
  const both = parts.map(metres)
  return both.length === 2 && both[0] !== null && both[1] !== null ? [both[0], both[1]] : null
}

/** An angle in degrees as typed; null of what is none. @param {string} text @returns {number | null} */
export function degrees(text) {
  if (text.trim() === '') return 0
  const found = /^\s*([+-]?[0-9]*[.,]?[0-9]+)\s*(deg|°|rad)?\s*$/.exec(text)
  if (!found) return null
  const value = Number(found[1].replace(',', '.'))
  return found[2] === 'rad' ? (value * 180) / Math.PI : value
}

/** Whether what is drawn is what a camera sees, and no picture. @param {string} picture */
export const isCamera = (picture) => picture.startsWith('camera:')

/** Whether a simulated camera sees it, in a simulated room. @param {string} picture */
export const isRoom = (picture) => picture.startsWith('camera:sim')

/** What people call a picture, or a camera. @param {string} picture */
export const called = (picture) => (isCamera(picture) ? `Camera: ${picture.slice(7)}` : picture)

/** All values of a flag that may be given again. @param {string | boolean | string[] | null | undefined} value @returns {string[]} */
export const listed = (value) => (Array.isArray(value) ? value : typeof value === 'string' && value !== '' ? [value] : [])

/** A number without needless digits. @param {number} value @param {number} digits */
export function plain(value, digits) {
  return String(Number(value.toFixed(digits)) + 0)
}

/** A length for people. @param {number} m */
export function length(m) {
  if (shown.imperial) return Math.abs(m) >= 10 * UNITS.ft ? `${plain(m / UNITS.ft, 2)} ft` : `${plain(m / UNITS.in, 2)} in`
  if (Math.abs(m) >= 1) return `${plain(m, 2)} m`
  if (Math.abs(m) >= 0.1) return `${plain(m * 100, 1)} cm`
  return `${plain(m * 1000, 1)} mm`
}

/** A length as the program reads it. @param {number} m */
export function typed(m) {
  return shown.imperial ? `${plain(m / UNITS.in, 3)}in` : `${plain(m * 1000, 1)}mm`
}

/** Minutes and seconds. @param {number} s */
export function clock(s) {
  const all = Math.round(s)
  return `${Math.floor(all / 60)}:${String(all % 60).padStart(2, '0')}`
}

/** A time for people. @param {number} s */
export function time(s) {
  const all = Math.round(s)
  return s < 59.95 ? `${plain(s, 1)} s` : `${Math.floor(all / 60)} min ${all % 60} s`
}

/** Bytes for people. @param {number} bytes */
export function size(bytes) {
  if (bytes < 1e4) return `${bytes} B`
  return bytes < 1e6 ? `${plain(bytes / 1e3, 0)} kB` : `${plain(bytes / 1e6, 1)} MB`
}

/** What a path ends with. @param {string} path */
export const named = (path) => path.split(/[\\/]/).pop() ?? path
