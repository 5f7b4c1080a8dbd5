// @ts-check
/** Elements of the page: found by their id, and made. */

/** @template {HTMLElement} T @param {string} id @returns {T} */
export const by = (id) => /** @type {T} */ (document.getElementById(id))

/** Elements of text, classes and children. @param {string} name @param {{ text?: string, class?: string, [attribute: string]: string | undefined }} [how] @param {(Node | string)[]} children */
export function element(name, how = {}, ...children) {
  const made = document.createElement(name)
  for (const [key, value] of Object.entries(how)) {
    if (key === 'text') made.textContent = value ?? ''
    else if (value !== undefined) made.setAttribute(key, value)
  }
  made.append(...children)
  return made
}

/** Makes something when it is first asked for; what fails is tried again. @template T @param {() => Promise<T>} make @returns {() => Promise<T>} */
export function once(make) {
  /** @type {Promise<T> | null} */
  let made = null
  return () => {
    made ??= make().catch((error) => {
      made = null
      throw error
    })
    return made
  }
}
