// Numbers as people read and type them. Prefixes move the decimal point of the shortest text of a double, so nothing is rounded.

const prefixes: [number, string][] = [
  [9, 'G'],
  [6, 'M'],
  [3, 'k'],
  [0, ''],
  [-3, 'm'],
  [-6, 'µ'],
  [-9, 'n'],
]

interface Decimal {
  negative: boolean
  digits: string
  exponent: number // of the digit before the point
}

function decimalOf(text: string): Decimal {
  const match = /^([+-]?)(\d*)\.?(\d*)(?:e([+-]?\d+))?$/i.exec(text)
  if (!match) throw new Error(`no number: ${text}`)
  const [, sign, whole = '', fraction = '', power] = match
  const all = whole + fraction
  const zeros = /^0*/.exec(all)![0].length
  const digits = all.slice(zeros).replace(/0+$/, '')
  if (digits === '') return { negative: false, digits: '0', exponent: 0 }
  return { negative: sign === '-', digits, exponent: whole.length - 1 - zeros + Number(power ?? 0) }
}

function textOf({ negative, digits, exponent }: Decimal): string {
  const sign = negative ? '-' : ''
  if (exponent < -4 || exponent > 9) {
    return `${sign}${digits[0]}${digits.length > 1 ? '.' + digits.slice(1) : ''}e${exponent}`
  }
  if (exponent < 0) return `${sign}0.${'0'.repeat(-exponent - 1)}${digits}`
  const whole = digits.slice(0, exponent + 1).padEnd(exponent + 1, '0')
  const fraction = digits.slice(exponent + 1)
  return sign + whole + (fraction ? '.' + fraction : '')
}

/** The same digits times 10^places, exactly. */
export function shifted(text: string, places: number): string {
  const decimal = decimalOf(text)
  return decimal.digits === '0' ? '0' : textOf({ ...decimal, exponent: decimal.exponent + places })
}

/** Whether a prefix may stand before the unit's first letter: "kN/m" yes, "kkg" no. */
const takesPrefix = (unit: string): boolean => /^(N|s|m|Hz|J|rad)\b/.test(unit) && !/^m²/.test(unit)

export interface Shown {
  number: string
  unit: string // with its prefix
  places: number // power of ten of the prefix
}

/** With all its digits, or rounded to so many where `digits` is given. */
export function shown(value: number, unit: string, digits?: number): Shown {
  unit = unit.replace('m^2', 'm²') // as the documents write it
  const text = digits === undefined ? String(value) : Number(value.toPrecision(digits)).toString()
  if (!Number.isFinite(value)) return { number: String(value), unit, places: 0 }
  const decimal = decimalOf(text)
  if (decimal.digits === '0' || !takesPrefix(unit)) return { number: textOf(decimal), unit, places: 0 }
  // Beyond the prefixes a power of ten says more than a prefix beside one.
  if (decimal.exponent < -12 || decimal.exponent > 12) return { number: textOf(decimal), unit, places: 0 }
  // From 0.1 to 1000 a number reads best without a prefix.
  const [places, prefix] =
    decimal.exponent === -1 ? [0, ''] : (prefixes.find(([power]) => decimal.exponent >= power) ?? prefixes[prefixes.length - 1]!)
  return { number: textOf({ ...decimal, exponent: decimal.exponent - places }), unit: prefix + unit, places }
}

/** "8.849 kN/m"; "none" for what does not exist. */
export function say(value: number | null | undefined, unit: string, digits = 4): string {
  if (value === null || value === undefined) return 'none'
  const { number, unit: full } = shown(value, unit, digits)
  return full ? `${number} ${full}` : number
}

/** Numbers side by side in one unit: with the prefix of the greatest, as long as the least is read well with it. */
export function sayAlike(
  values: (number | null | undefined)[],
  unit: string,
): (value: number | null | undefined, digits?: number) => string {
  const sizes = values.filter((each): each is number => typeof each === 'number' && Number.isFinite(each) && each > 0)
  const greatest = shown(Math.max(...sizes, 0), unit, 4)
  const isFar = Math.min(...sizes) * 10 ** -greatest.places < 0.01
  return (value, digits = 4) =>
    typeof value !== 'number' || isFar || !Number.isFinite(value)
      ? say(value, unit, digits)
      : `${shifted(Number(value.toPrecision(digits)).toString(), -greatest.places)} ${greatest.unit}`.trim()
}

/** Three digits, two below 1 %. */
export const percent = (share: number, digits = Math.abs(share) < 0.01 ? 2 : 3): string =>
  `${share > 0 ? '+' : share < 0 ? '−' : ''}${shown(Math.abs(share * 100), '', digits).number} %`

const number = String.raw`[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?`
const plain = new RegExp(`^${number}$`)
const measured = new RegExp(`^(${number})\\s*([^\\s,].*)$`)

/** A value of a device file: a plain number is SI, a text has its own unit, which only the server reads. */
export interface Written {
  number: number
  unit: string | null
}

export function written(value: unknown): Written | null {
  if (typeof value === 'number') return { number: value, unit: null }
  if (typeof value !== 'string') return null
  const match = measured.exec(value.trim())
  return match ? { number: Number(match[1]), unit: match[2]! } : null
}

/**
 * What was typed, as TOML. A number alone is SI, whatever unit stood there; with the unit that is shown of an SI number, prefix
 * and all, the point moves. Anything else goes to the server as it is.
 */
export function tomlOfTyped(typed: string, { unit, places }: { unit: string; places: number } = { unit: '', places: 0 }): string {
  const text = typed.trim().replace(/−/g, '-')
  const bare = unit && text.endsWith(unit) ? text.slice(0, -unit.length).trim() : text
  return plain.test(bare) ? shifted(bare.replace(/^\+/, ''), bare === text ? 0 : places) : JSON.stringify(text)
}

/** A number as TOML; "2000" is a good number there. */
export const tomlOfNumber = (value: number): string => String(value).replace('e+', 'e')

/** Four digits are enough for a step or a drag. */
export const rounded = (value: number): number => Number(value.toPrecision(4))

/** The whole part or multiple of a period that is nearest to a value; from `from` on at least one step towards it. */
export function wholeRatio(value: number, period: number, from?: number): number {
  const most = 999
  const stepOf = (each: number): number => (each >= period ? Math.round(each / period) - 1 : 1 - Math.round(period / each))
  let step = stepOf(value)
  if (from !== undefined && step === stepOf(from)) step += Math.sign(value - from)
  step = Math.max(-most, Math.min(most, step))
  return Number((step < 0 ? period / (1 - step) : period * (1 + step)).toPrecision(12))
}

const inSi: Record<string, number> = { rad: 1, mrad: 1e-3, deg: Math.PI / 180, '°': Math.PI / 180, m: 1, cm: 1e-2, mm: 1e-3 }
/** How many rad or m one of a joint's unit is; null of a unit that the page does not turn. */
export const siOfPosition = (unit: string | null): number | null => (unit === null ? 1 : (inSi[unit] ?? null))
