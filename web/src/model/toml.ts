// Where each value of a TOML text stands, so that one number is replaced and all else (comments, order, units) stays.
// It judges nothing: the server parses the text and says what is wrong with it.

export type TomlValue = number | string | boolean | TomlValue[]

export interface Entry {
  path: string[] // ["body", "0", "mass"]: tables of an array have their index
  start: number // of the value in the text
  end: number
  value: TomlValue
}

interface Table {
  path: string[]
  start: number
  insertAt: number // where one more key goes
  kind: 'header' | 'inline' | 'dotted'
  empty: boolean
}

export interface Scan {
  entries: Entry[]
  tables: Table[]
  comments: { start: number; end: number }[]
  complete: boolean // false: stopped at something unexpected
}

export const samePath = (a: string[], b: string[]): boolean => a.length === b.length && a.every((part, i) => part === b[i])

const escapes: Record<string, string> = { b: '\b', t: '\t', n: '\n', f: '\f', r: '\r', '"': '"', '\\': '\\' }
/** What stands between double quotes; a backslash at the end of a line takes the line's end and the spaces behind it away. */
const unescaped = (inside: string): string =>
  inside.replace(
    /\\(?:u([\da-fA-F]{4})|U([\da-fA-F]{8})|([btnfr"\\])|[ \t]*\r?\n\s*)/g,
    (_, four?: string, eight?: string, one?: string) => {
      const code = Number.parseInt(four ?? eight ?? '', 16)
      return one !== undefined ? escapes[one]! : code <= 0x10ffff ? String.fromCodePoint(code) : ''
    },
  )

/** A key as a file has it: quoted where it is no bare one. */
export const keyText = (key: string): string => (/^[\w-]+$/.test(key) ? key : JSON.stringify(key))
const pathText = (path: string[]): string => path.map(keyText).join('.')

/** Lines as a value: as they are where they may be, else with escapes. */
export function tomlOfLines(text: string): string {
  const lines = text.replaceAll('\r\n', '\n')
  const isPlain = !/'''|'$|[\u0000-\u0008\u000b-\u001f\u007f]/.test(lines)
  if (isPlain) return `'''\n${lines}'''`
  const escaped = lines.split('\n').map((line) => JSON.stringify(line).slice(1, -1).replaceAll('\u007f', '\\u007f'))
  return `"""\n${escaped.join('\n')}"""`
}

class Reader {
  at = 0
  scan: Scan = { entries: [], tables: [], comments: [], complete: true }
  private counts = new Map<string, number>()

  constructor(readonly text: string) {}

  run(): Scan {
    try {
      this.document()
    } catch {
      this.scan.complete = false
    }
    return this.scan
  }

  private document(): void {
    let table: string[] = []
    for (;;) {
      this.blank(true)
      if (this.at >= this.text.length) return
      if (this.text[this.at] === '[') {
        const start = this.at
        table = this.header()
        this.blank(false)
        this.scan.tables.push({ path: table, start, insertAt: this.at, kind: 'header', empty: true })
      } else {
        this.keyValue(table, 'header')
      }
    }
  }

  /** Spaces and a comment; over the ends of lines too where `lines`. */
  private blank(lines: boolean): void {
    for (; this.at < this.text.length; ++this.at) {
      const c = this.text[this.at]!
      if (c === '#') {
        const start = this.at
        while (this.at < this.text.length && this.text[this.at] !== '\n') ++this.at
        this.scan.comments.push({ start, end: this.at })
        --this.at
      } else if (c !== ' ' && c !== '\t' && c !== '\r' && !(lines && c === '\n')) {
        return
      }
    }
  }

  private expect(token: string): void {
    if (!this.text.startsWith(token, this.at)) throw new Error(token)
    this.at += token.length
  }

  private header(): string[] {
    const many = this.text.startsWith('[[', this.at)
    this.expect(many ? '[[' : '[')
    const names = this.key()
    this.blank(false)
    this.expect(many ? ']]' : ']')
    const path: string[] = []
    names.forEach((name, i) => {
      path.push(name)
      const id = path.join('\n')
      if (many && i === names.length - 1) this.counts.set(id, (this.counts.get(id) ?? -1) + 1)
      const count = this.counts.get(id)
      if (count !== undefined) path.push(String(count))
    })
    return path
  }

  private key(): string[] {
    const parts: string[] = []
    for (;;) {
      this.blank(false)
      const c = this.text[this.at]
      if (c === '"' || c === "'") {
        parts.push(String(this.value()))
      } else {
        const bare = /^[\p{L}\p{N}_-]+/u.exec(this.text.slice(this.at, this.at + 300))
        if (!bare) throw new Error('key')
        parts.push(bare[0])
        this.at += bare[0].length
      }
      this.blank(false)
      if (this.text[this.at] !== '.') return parts
      ++this.at
    }
  }

  private keyValue(table: string[], kind: Table['kind']): void {
    const names = this.key()
    this.expect('=')
    this.blank(false)
    const path = [...table, ...names]
    const start = this.at
    if (this.text[this.at] === '{') {
      this.inlineTable(path)
    } else {
      const value = this.value()
      this.scan.entries.push({ path, start, end: this.at, value })
    }
    const home = this.scan.tables.findLast((each) => samePath(each.path, table))
    if (home) Object.assign(home, { insertAt: this.at, empty: false })
    if (kind !== 'inline' && names.length > 1) {
      this.scan.tables.push({ path: path.slice(0, -1), start, insertAt: this.at, kind: 'dotted', empty: false })
    }
  }

  private inlineTable(path: string[]): void {
    this.expect('{')
    const table: Table = { path, start: this.at, insertAt: this.at, kind: 'inline', empty: true }
    this.scan.tables.push(table)
    for (;;) {
      this.blank(true)
      if (this.text[this.at] === '}') break
      this.keyValue(path, 'inline')
      this.blank(true)
      if (this.text[this.at] === ',') ++this.at
    }
    this.expect('}')
  }

  private value(): TomlValue {
    const c = this.text[this.at]
    if (c === '[') return this.array()
    if (c === '"' || c === "'") return this.string(c)
    const token = /^[^\s,\]}#=]+/.exec(this.text.slice(this.at, this.at + 400))
    if (!token) throw new Error('value')
    this.at += token[0].length
    if (token[0] === 'true' || token[0] === 'false') return token[0] === 'true'
    const number = Number(token[0].replaceAll('_', ''))
    return Number.isNaN(number) ? token[0] : number
  }

  private string(quote: string): string {
    const long = quote.repeat(3)
    const end = this.text.startsWith(long, this.at) ? long : quote
    const start = (this.at += end.length)
    while (!this.text.startsWith(end, this.at)) {
      if (this.at >= this.text.length || (end === quote && this.text[this.at] === '\n')) throw new Error('string')
      this.at += quote === '"' && this.text[this.at] === '\\' ? 2 : 1
    }
    if (end === long) for (let i = 0; i < 2 && this.text[this.at + 3] === quote; ++i) ++this.at // quotes of the text itself
    const inside = this.text.slice(start, this.at).replace(/^\r?\n/, '')
    this.at += end.length
    return quote === "'" ? inside : unescaped(inside)
  }

  private array(): TomlValue[] {
    const values: TomlValue[] = []
    this.expect('[')
    for (;;) {
      this.blank(true)
      if (this.text[this.at] === ']') break
      values.push(this.value())
      this.blank(true)
      if (this.text[this.at] === ',') ++this.at
    }
    this.expect(']')
    return values
  }
}

const known = new Map<string, Scan>() // the least recently used first
export function scan(text: string): Scan {
  const found = known.get(text) ?? new Reader(text).run()
  known.delete(text)
  known.set(text, found)
  if (known.size > 60) known.delete(known.keys().next().value!)
  return found
}

export const find = (scanned: Scan, path: string[]): Entry | undefined => scanned.entries.find((each) => samePath(each.path, path))

function lineEnd(text: string, at: number): number {
  const end = text.indexOf('\n', at)
  return end < 0 ? text.length : end
}

/** The text with these lines behind the last table of that array, at its end where there is none. */
export function append(text: string, path: string[], lines: string): string {
  const last = scan(text).tables.findLast((each) => each.kind === 'header' && path.every((part, i) => each.path[i] === part))
  const at = last ? lineEnd(text, last.insertAt) : text.replace(/\n*$/, '').length
  return `${text.slice(0, at)}\n\n${lines}${text.slice(at) || '\n'}`
}

/** The text without that table; comments behind it stay, as they may be the next one's. */
export function removeTable(text: string, path: string[]): string {
  const table = scan(text).tables.find((each) => each.kind === 'header' && samePath(each.path, path))
  return table ? text.slice(0, table.start) + text.slice(lineEnd(text, table.insertAt)).replace(/^\n+/, '') : text
}

/** The table, or the inline one around it, within which no header may stand for it. */
const tableOf = ({ tables }: Scan, path: string[]): Table | undefined =>
  tables.findLast((each) => samePath(each.path, path)) ??
  tables.findLast(({ kind, path: own }) => kind === 'inline' && own.every((part, i) => part === path[i]))

/** The text with that value in place of the old one, or added to its table, which is added where it is missing. */
export function set(text: string, path: string[], raw: string): string {
  const scanned = scan(text)
  const entry = find(scanned, path)
  if (entry) return text.slice(0, entry.start) + raw + text.slice(entry.end)
  const parent = path.slice(0, -1)
  const key = path[path.length - 1]!
  const table = tableOf(scanned, parent)
  if (!table) return `${text.replace(/\n*$/, '\n')}\n[${pathText(parent)}]\n${keyText(key)} = ${raw}\n`
  const insert = (what: string): string => text.slice(0, table.insertAt) + what + text.slice(table.insertAt)
  if (table.kind === 'inline') {
    const line = `${pathText(path.slice(table.path.length))} = ${raw}`
    return insert(table.empty ? ` ${line} ` : `, ${line}`)
  }
  const at = lineEnd(text, table.insertAt)
  const name = table.kind === 'dotted' ? pathText(path) : keyText(key)
  return `${text.slice(0, at)}\n${name} = ${raw}${text.slice(at)}`
}

/** The text without that value and its key, and the comment on its line; as it was where that would change anything else. */
export function unset(text: string, path: string[]): string {
  const scanned = scan(text)
  const entry = find(scanned, path)
  const parent = tableOf(scanned, path.slice(0, -1))
  if (!entry) return text
  const isInline = parent?.kind === 'inline'
  const before = text.slice(0, entry.start).replace(isInline ? /[^{,]*$/ : /[^\n]*$/, '')
  const after = isInline ? text.slice(entry.end) : text.slice(lineEnd(text, entry.end) + 1)
  const without = isInline
    ? before.trimEnd().endsWith(',')
      ? before.trimEnd().slice(0, -1) + after
      : before + after.replace(/^\s*,/, '')
    : before + after
  const others = (entries: Entry[]): string => JSON.stringify(entries.map((each) => [each.path, each.value]))
  const left = scan(without)
  return left.complete && others(left.entries) === others(scanned.entries.filter((each) => each !== entry)) ? without : text
}

/** The text without its comments and empty lines; every value is the same. */
export function withoutComments(text: string): string {
  const { comments, entries } = scan(text)
  const lines = entries.filter(({ start, end, value }) => typeof value === 'string' && text.slice(start, end).includes('\n'))
  /** What stands between texts of several lines. */
  const between = (from: number, to: number): string => {
    const inside = comments.filter((each) => each.start >= from && each.end <= to)
    const left = inside.reduceRight((out, { start, end }) => out.slice(0, start - from) + out.slice(end - from), text.slice(from, to))
    return left.replace(/[ \t]+$/gm, '').replace(/\n{2,}/g, '\n')
  }
  let out = ''
  let done = 0
  for (const { start, end } of lines) {
    out += between(done, start) + text.slice(start, end)
    done = end
  }
  return (out + between(done, text.length)).replace(/^\n/, '')
}
