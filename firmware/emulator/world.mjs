// What is around the board, as one module: the simulated head and a host.

import { readFileSync } from 'node:fs'

export const openWorld = module => new WebAssembly.Instance(new WebAssembly.Module(readFileSync(module))).exports

// A host at the board's line: it homes the head, arms it and has a circle drawn.
export class Host {
  constructor(world, session, { arms = true } = {}) {
    Object.assign(this, { world, isSilent: false })
    world.host(session, arms ? 1 : 0)
  }

  // What it says, having heard this.
  says(heard, now) {
    if (this.isSilent) return new Uint8Array(0)
    const { world } = this
    const bytes = () => new Uint8Array(world.memory.buffer, world.bytes())
    bytes().set(heard)
    const length = world.hear(heard.length, Math.round(now / 1000))
    return bytes().slice(0, length)
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
