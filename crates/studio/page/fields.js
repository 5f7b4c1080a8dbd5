// @ts-check
/** The form: a field a flag, with the flag's name and the values of the command line. */

/**
 * @typedef {import('./api.js').Flags} Flags
 * @typedef {{ flag: string, label: string, hint?: string, choices?: [string, string][], check?: boolean }} Field
 */

/** @type {{ title: string, open: boolean, fields: Field[] }[]} */
const GROUPS = [
  {
    title: 'Size and place',
    open: true,
    fields: [
      { flag: 'width', label: 'Width', hint: '24in, 60cm, 3m' },
      { flag: 'height', label: 'or height', hint: 'follows' },
      { flag: 'from', label: 'Measured from', choices: [['', 'the middle'], ['bottom-left', 'left edge and floor'], ['bottom-right', 'right edge and floor'], ['top-left', 'left edge and top'], ['top-right', 'right edge and top']] },
      { flag: 'origin', label: 'Where that corner is', hint: '-1.5m,-1.2m' },
      { flag: 'offset', label: 'Right, up', hint: '10cm,-5cm' },
      { flag: 'rotate', label: 'Turn', hint: '15deg' },
      { flag: 'distance', label: 'Head’s distance', hint: '3ft' },
      { flag: 'head', label: 'Head stands', choices: [['', 'square-on before the middle']] },
      { flag: 'flip', label: 'Mirror', check: true },
    ],
  },
  {
    title: 'Picture',
    open: false,
    fields: [
      { flag: 'mode', label: 'Lines', choices: [['', 'by their width'], ['centreline', 'middle of every line'], ['outline', 'edge of all ink']] },
      { flag: 'threshold', label: 'Least contrast', hint: 'auto, 30' },
      { flag: 'despeckle', label: 'Smallest speck', hint: 'auto, 20' },
      { flag: 'min_length', label: 'Shortest stroke', hint: '8px, 5mm' },
      { flag: 'layer', label: 'Only layer', hint: 'studs' },
      { flag: 'colour', label: 'Only colour', hint: 'red, #1f63c4' },
      { flag: 'unit', label: 'Unit of a DXF', choices: [['', 'as the file says'], ['mm', 'mm'], ['cm', 'cm'], ['m', 'm'], ['in', 'in'], ['ft', 'ft']] },
    ],
  },
  {
    title: 'Sheet of paper',
    open: false,
    fields: [
      { flag: 'paper', label: 'Its size', choices: [['', 'not known'], ['a5', 'A5'], ['a4', 'A4'], ['a3', 'A3'], ['letter', 'Letter'], ['legal', 'Legal']] },
      { flag: 'straighten', label: 'Its corners', hint: 'auto, off' },
      { flag: 'whole', label: 'Trace beside it too', check: true },
      { flag: 'sheets', label: 'Leave out edges of paper', check: true },
      { flag: 'force', label: 'Also a photograph', check: true },
    ],
  },
  {
    title: 'Time and head',
    open: false,
    fields: [
      { flag: 'speed', label: 'Speed of the spot', hint: '1ft/s' },
      { flag: 'lit_speed', label: 'At corners', choices: [['', 'fastest'], ['exact', 'one constant speed'], ['stops', 'stop at each']] },
      { flag: 'order', label: 'Order', choices: [['', 'least time'], ['layer', 'layer by layer'], ['reading', 'row by row']] },
      { flag: 'rig', label: 'Head', choices: [['', 'report: as of 2006'], ['worn', 'worn: play, age'], ['stepper', 'stepper: two stepper motors'], ['servo', 'servo: hobby servos']] },
    ],
  },
]

/** Fields elsewhere on the page. @type {[string, string][]} */
const OTHERS = [['bottom-left', 'Bottom left'], ['bottom-right', 'Bottom right'], ['top-right', 'Top right'], ['top-left', 'Top left'], ['simulate', 'Only try it'], ['size', 'Width, height'], ['bar', 'Printed bar measures'], ['to', 'To']]

/** What a message calls a flag is what the form calls its field. @param {string} text */
export function asLabelled(text) {
  const labels = new Map([...OTHERS, ...GROUPS.flatMap((group) => group.fields.map((field) => /** @type {[string, string]} */ ([field.flag.replaceAll('_', '-'), field.label])))])
  return text.replace(/'?--([a-z][a-z-]*)( <[^>]*>)?'?/g, (all, flag) => (labels.has(flag) ? `“${labels.get(flag)}”` : all))
}

export class Fields {
  /** @param {HTMLFormElement} form @param {(flags: Flags) => void} changed */
  constructor(form, changed) {
    /** @type {Map<string, HTMLInputElement | HTMLSelectElement>} */
    this.inputs = new Map()
    for (const group of GROUPS) {
      const part = document.createElement('details')
      part.open = group.open
      const title = document.createElement('summary')
      title.textContent = group.title
      part.append(title, ...group.fields.map((field) => this.#row(field, changed)))
      form.append(part)
    }
    form.addEventListener('submit', (event) => event.preventDefault())
  }

  /** @param {Field} field @param {(flags: Flags) => void} changed */
  #row(field, changed) {
    const label = document.createElement('label')
    label.className = field.check ? 'row check' : 'row'
    label.dataset.flag = field.flag
    const text = document.createElement('span')
    text.textContent = field.label
    const input = field.choices ? document.createElement('select') : document.createElement('input')
    for (const [value, words] of field.choices ?? []) input.append(new Option(words, value))
    if (input instanceof HTMLInputElement) {
      input.type = field.check ? 'checkbox' : 'text'
      input.placeholder = field.hint ?? ''
      input.spellcheck = false
      if (!field.check) input.inputMode = 'text'
    }
    input.name = field.flag
    input.addEventListener('change', () => {
      const value = input instanceof HTMLInputElement && field.check ? input.checked : input.value.trim()
      // one of both says the other
      const other = /** @type {Record<string, Flags>} */ ({ width: { height: '' }, height: { width: '' }, distance: { head: '' }, head: { distance: '' } })
      // where a corner is means nothing without one
      const alone = /** @type {Flags} */ (field.flag === 'from' && !value ? { origin: '' } : {})
      changed({ ...(value ? other[field.flag] : {}), ...alone, [field.flag]: value })
    })
    label.append(text, input)
    this.inputs.set(field.flag, input)
    return label
  }

  /** The part of the form that a field is in. @param {string} flag */
  part(flag) {
    return /** @type {HTMLElement} */ (this.inputs.get(flag)?.closest('details'))
  }

  /** Gives the choice that is none of a field's own another name. @param {string} flag @param {string} words */
  name(flag, words) {
    const first = /** @type {HTMLSelectElement} */ (this.inputs.get(flag)).options[0]
    if (first) first.text = words
  }

  /** Gives a field one more choice, after its first. @param {string} flag @param {string} value @param {string} words */
  offer(flag, value, words) {
    const select = /** @type {HTMLSelectElement} */ (this.inputs.get(flag))
    if (![...select.options].some((option) => option.value === value)) select.add(new Option(words, value), 1)
  }

  /** Gives a field choices beside its own. @param {string} flag @param {[string, string][]} choices @param {Flags} flags what is asked for */
  also(flag, choices, flags) {
    const select = /** @type {HTMLSelectElement} */ (this.inputs.get(flag))
    for (const option of [...select.options]) if (option.dataset.also) option.remove()
    for (const [value, words] of choices) {
      const option = new Option(words, value)
      option.dataset.also = 'yes'
      select.append(option)
    }
    select.value = String(flags[flag] ?? '')
  }

  /** Shows what is asked for. @param {Flags} flags */
  show(flags) {
    for (const [flag, input] of this.inputs) {
      const value = flags[flag] ?? ''
      if (input instanceof HTMLInputElement && input.type === 'checkbox') input.checked = value === true
      else if (document.activeElement !== input || input.value.trim() !== value) input.value = String(value)
    }
  }

  /** Marks the field that a message is about; none of another. @param {string} message */
  blame(message) {
    for (const [flag, input] of this.inputs) {
      const is = message.includes(`--${flag.replaceAll('_', '-')} `) || message.includes(`--${flag.replaceAll('_', '-')}=`)
      if (is) {
        input.setAttribute('aria-invalid', 'true')
        input.closest('details')?.setAttribute('open', '')
      } else input.removeAttribute('aria-invalid')
    }
  }
}
