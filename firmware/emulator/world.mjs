// What is around the board, as one module: the simulated head and a host.

import { readFileSync } from 'node:fs'

// The module reads so many bytes at once.
const ROOM = 1 << 14

export const openWorld = module => new WebAssembly.Instance(new WebAssembly.Module(readFileSync(module))).exports

// A host at the board's line: it homes the head, arms it and has a circle drawn.
export class Host {
  constructor(world, session, { arms = true } = {}) {
    Object.assign(this, { world, isSilent: false, unread: Buffer.alloc(0) })
    world.host(session, arms ? 1 : 0)
  }

  // What it says, having heard this. One that hangs says nothing, and reads what came when it is back.
  says(heard, now) {
    this.unread = Buffer.concat([this.unread, heard])
    const said = []
    while (!this.isSilent) {
      const { world } = this
      const bytes = () => new Uint8Array(world.memory.buffer, world.bytes())
      const piece = this.unread.subarray(0, ROOM)
      this.unread = this.unread.subarray(piece.length)
      bytes().set(piece)
      const length = world.hear(piece.length, Math.round(now / 1000))
      said.push(bytes().slice(0, length))
      if (this.unread.length === 0) break
    }
    return Buffer.concat(said)
  }

  text(length) {
    return Buffer.from(this.world.memory.buffer, this.world.bytes(), length).toString()
  }

  get fault() {
    return this.text(this.world.fault()) || null
  }

  get trouble() {
    return this.text(this.world.trouble()) || null
  }

  get stage() {
    return this.world.stage()
  }

  get draws() {
    return this.world.draws() === 1
  }
}
