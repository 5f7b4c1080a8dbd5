// @ts-check
/** Where a drawing lies: as flags of the command line, and as a box on the wall. */

import { degrees, listed, metres, offset, plain, typed } from './words.js'

/**
 * @typedef {import('./api.js').Flags} Flags
 * @typedef {import('./wall.js').Box} Box
 */

/** Which way lengths go from a corner of the wall: right or left, up or down. */
const WAYS = /** @type {Record<string, [number, number]>} */ ({ 'bottom-right': [-1, 1], 'top-left': [1, -1], 'top-right': [-1, -1] })

/** @param {Flags} flags */
export const ways = (flags) => WAYS[String(flags.from)] ?? [1, 1]

/** Where on the wall lengths are measured from, m. @param {Flags} flags @returns {[number, number]} */
export const origin = (flags) => (flags.from ? offset(String(flags.origin ?? '')) : null) ?? [0, 0]

/** So far from where it is measured from, as the program reads it. @param {[number, number]} at m @param {Flags} flags */
export function told([x, y], flags) {
  const [[right, up], [left, low]] = [ways(flags), origin(flags)]
  return `${typed(right * (x - left))},${typed(up * (y - low))}`
}

/** Where the planned drawing lies. @param {import('./api.js').Plan} of @returns {Box} */
export function planned(of) {
  const { corners_m: corners, width_m: width, height_m: height } = of.plan.target
  const [x, y] = [0, 1].map((n) => corners.reduce((sum, corner) => sum + corner[n], 0) / 4)
  const [up_x, up_y] = [corners[0][0] - corners[3][0], corners[0][1] - corners[3][1]]
  return { x, y, turn: Math.atan2(-up_x, up_y), width, height }
}

/** Where the drawing is to be by its flags, as far as the page can tell before it is planned. @param {Flags} flags @param {Box} was where it was planned @param {Flags} by by these */
export function boxOf(flags, was, by) {
  const is_measured_alike = ['from', 'origin'].every((flag) => (flags[flag] ?? '') === (by[flag] ?? ''))
  if (!is_measured_alike) return was
  if (listed(flags.align).length > 0 || listed(by.align).length > 0) return byMarks(flags, was, by)
  const [to, from] = [offset(String(flags.offset ?? '')), offset(String(by.offset ?? ''))]
  const [right, up] = ways(flags)
  const degree = degrees(String(flags.rotate ?? ''))
  const turn = degree === null ? was.turn : (degree * Math.PI) / 180
  if (!to || !from) return { ...was, turn }
  return { ...was, x: was.x + right * (to[0] - from[0]), y: was.y + up * (to[1] - from[1]), turn }
}

/** Where it is to be by marks that were all moved alike; by any others where it was. @param {Flags} flags @param {Box} was @param {Flags} by @returns {Box} */
function byMarks(flags, was, by) {
  const [to, from] = [listed(flags.align), listed(by.align)].map((marks) => marks.map((mark) => offset(mark.split('=')[1] ?? '')))
  const ways_m = to.map((at, n) => (at && from[n] ? [at[0] - from[n][0], at[1] - from[n][1]] : null))
  const [first] = ways_m
  const is_alike = to.length === from.length && ways_m.every((way) => way && first && Math.hypot(way[0] - first[0], way[1] - first[1]) < 2e-4)
  if (!first || !is_alike) return was
  const [right, up] = ways(flags)
  return { ...was, x: was.x + right * first[0], y: was.y + up * first[1] }
}

/** The corner of a box's bounds that its offset is that of. @param {Box} box @param {Flags} flags @returns {[number, number]} */
function corner({ x, y, turn, width, height }, flags) {
  if (!flags.from || flags.from === 'centre') return [x, y]
  const [right, up] = ways(flags)
  const [cos, sin] = [Math.abs(Math.cos(turn)), Math.abs(Math.sin(turn))]
  return [x - (right * (width * cos + height * sin)) / 2, y - (up * (width * sin + height * cos)) / 2]
}

/** Where a box lies, as flags: what did not change stays as it was typed. @param {Box} box @param {Box} is where it lies by its flags @param {Flags} flags @returns {Flags} */
export function flagsOf(box, is, flags) {
  /** @type {Flags} */
  const change = {}
  const is_sized = Math.abs(box.width - is.width) > 5e-5
  const is_turned = Math.abs(box.turn - is.turn) > 1e-4
  if (is_sized) Object.assign(change, { width: typed(box.width), height: '' })
  if (is_turned) change.rotate = `${plain((box.turn * 180) / Math.PI, 1)}deg`
  const [[to_x, to_y], [from_x, from_y]] = [corner(box, flags), corner(is, flags)]
  const [right, up] = ways(flags)
  const [dx, dy] = [right * (to_x - from_x), up * (to_y - from_y)]
  if (Math.hypot(dx, dy) <= 5e-5) return change
  const marks = listed(flags.align)
  if (marks.length > 0) {
    // it is sized and turned about its mark
    const moved = marks.map((mark) => shifted(mark, dx, dy))
    // one by angles stays where the head was: with it nothing can be moved
    if (!is_sized && !is_turned && moved.every((mark) => mark !== null)) change.align = /** @type {string[]} */ (moved)
    return change
  }
  const was = offset(String(flags.offset ?? ''))
  if (was) change.offset = `${typed(was[0] + dx)},${typed(was[1] + dy)}`
  // what the page cannot read is what it was planned by: from the middle that is where it lies
  else if (!flags.from || flags.from === 'centre') change.offset = told([box.x, box.y], flags)
  return change
}

/** What is measured from another corner of the wall from now on, and stays where it is: offset, marks and areas. @param {Flags} was @param {Flags} flags with the other corner @param {Box} box where the drawing lies @returns {Flags} */
export function measuredAnew(was, flags, box) {
  /** @type {Flags} */
  const change = {}
  const place = (/** @type {string} */ text) => {
    const lengths = offset(text)
    const [[right, up], [x, y]] = [ways(was), origin(was)]
    return lengths && told([x + right * lengths[0], y + up * lengths[1]], flags)
  }
  const marks = listed(was.align)
  if (marks.length > 0) {
    change.align = marks.map((mark) => {
      const [at, to] = mark.split('=')
      const anew = place(to ?? '')
      return anew === null ? mark : `${at}=${anew}`
    })
  } else if (was.from || flags.from || was.offset) {
    const at = told(corner(box, flags), flags)
    change.offset = offset(at)?.every((m) => m === 0) ? '' : at
  }
  if (listed(was.no_go).length > 0) {
    change.no_go = listed(was.no_go).map((area) => {
      const [x, y, wide, high] = area.split(',').map(metres)
      if (x == null || y == null || wide == null || high == null) return area
      const [[right, up], [from_x, from_y]] = [ways(was), origin(was)]
      const [left, low] = [from_x + right * x - (right < 0 ? wide : 0), from_y + up * y - (up < 0 ? high : 0)]
      return areaOf([left, low, left + wide, low + high], flags)
    })
  }
  return change
}

/** An area of the wall as the program reads it. @param {[number, number, number, number]} of left, low, right, top, m @param {Flags} flags */
export function areaOf([left, low, right, top], flags) {
  const [[to_right, to_up], [x, y]] = [ways(flags), origin(flags)]
  return [to_right > 0 ? left - x : x - right, to_up > 0 ? low - y : y - top, right - left, top - low].map(typed).join(',')
}

/** A mark that belongs so much further away; null of one by angles. @param {string} mark @param {number} dx @param {number} dy */
function shifted(mark, dx, dy) {
  const [at, to] = mark.split('=')
  const [x, y] = (to ?? '').split(',').map((text) => metres(text))
  return x == null || y == null ? null : `${at}=${typed(x + dx)},${typed(y + dy)}`
}

/** Whether an area is one of the wall, right, up, width, height, and no layer's name. @param {string} area */
const isArea = (area) => area.split(',').length === 4

/** What is of the wall and the head, whatever is drawn. @param {Flags} flags @returns {Flags} */
export function ofWall({ distance, head, rig, from, origin, no_go }) {
  const areas = listed(no_go).filter(isArea)
  const all = Object.entries({ distance, head, rig, from, origin }).filter(([, value]) => value)
  return { .../** @type {Flags} */ (Object.fromEntries(all)), ...(areas.length > 0 ? { no_go: areas } : {}) }
}

/** The flags of a picture that comes onto a wall: as it lay there before, unless lengths are measured from elsewhere now. @param {Flags | undefined} own @param {Flags} wall @returns {Flags} */
export function onWall(own, wall) {
  const { distance, head, rig, from, origin, no_go, offset, align, ...others } = own ?? {}
  const is_alike = (from || '') === (wall.from || '') && (origin || '') === (wall.origin || '')
  const lies = Object.fromEntries(Object.entries({ offset, align }).filter(([, value]) => is_alike && value))
  const areas = [...listed(wall.no_go), ...listed(no_go).filter((area) => !isArea(area))]
  return { ...others, ...lies, ...wall, ...(areas.length > 0 ? { no_go: areas } : {}) }
}
