// The page's questions as the command line, C++ and Python ask them: the same numbers.

import type { Options } from '../api/answer.svelte'
import { groupsOf, type Row } from './keys'
import { scan, type Entry } from './toml'
import { workbench } from './workbench.svelte'

/** What a terminal may act on when it is pasted. */
const hasControls = (text: string): boolean => /[\u0000-\u0008\u000b-\u001f\u007f-\u009f]/.test(text)

/** Between the single quotes of a shell, for printf: every byte of a control character as \ooo. */
const printfFormat = (text: string): string =>
  text
    .replaceAll('\\', '\\\\')
    .replaceAll('%', '%%')
    .replaceAll("'", "'\\''")
    .replace(/[\u0000-\u0008\u000b-\u001f\u007f-\u009f]/g, (c) =>
      [...new TextEncoder().encode(c)].map((byte) => `\\${byte.toString(8).padStart(3, '0')}`).join(''),
    )

const quoted = (text: string): string =>
  /^[\w./:=,+-]+$/.test(text) ? text : hasControls(text) ? `"$(printf '${printfFormat(text)}')"` : `'${text.replaceAll("'", "'\\''")}'`

const rawOf = (text: string, entry: Entry): string => text.slice(entry.start, entry.end)

/** What --set makes of an example to get this text; null where it cannot. */
export function setsFrom(example: string, text: string): string[] | null {
  const [from, to] = [scan(example), scan(text)]
  if (!from.complete || !to.complete) return null
  const isDefault = ({ key, field }: Row, value: unknown): boolean =>
    value === 0 && key !== 'wall.stiffness' && !field.like && !field.travel
  const rowOf = new Map(groupsOf(to).flatMap((group) => group.rows.map((row) => [row.path.join('\n'), row])))
  const before = new Map(from.entries.map((each) => [each.path.join('\n'), rawOf(example, each)]))
  const sets: string[] = []
  for (const entry of to.entries) {
    const id = entry.path.join('\n')
    const old = before.get(id)
    before.delete(id)
    const row = rowOf.get(id)
    if (
      old === undefined
        ? row !== undefined && isDefault(row, entry.value)
        : old === rawOf(text, entry) || (typeof entry.value === 'number' && Number(old) === entry.value)
    )
      continue
    const key = row?.key ?? (id === 'mechanism\nnormal' ? 'mechanism.normal' : undefined)
    const isOne = typeof entry.value === 'number' || typeof entry.value === 'string'
    if (key === undefined || hasControls(rawOf(text, entry)) || (row && !isOne)) return null
    sets.push(`${key}=${typeof entry.value === 'string' ? entry.value : rawOf(text, entry)}`)
  }
  return before.size > 0 ? null : sets
}

const optionsText = (options: Options): string[] =>
  Object.entries(options).flatMap(([key, value]) => {
    const name = `--${key.replaceAll('_', '-')}`
    if (value === true) return [name]
    if (value === false || value === undefined || value === '') return []
    return (Array.isArray(value) ? value : [value]).flatMap((each) => [name, quoted(String(each))])
  })

/** The word itself where it is free, else with the first number behind it that is. */
function unused(word: string, isFree: (each: string) => boolean): string {
  for (let i = 0; ; ++i) {
    const each = i === 0 ? word : `${word}${i}`
    if (isFree(each)) return each
  }
}

/** The line with the whole file behind it: it gives the same in any folder. */
export function commandLine(command: string, options: Options = {}, text = workbench.toml): string {
  const words = command === 'recommend' ? ['design'] : [command]
  const all = command === 'recommend' ? { recommend: true, ...options } : options
  return withDevice(['zwidth', ...words, '-', ...optionsText(all)].join(' '), text)
}

/** Lines of a file, from 1: those above its table, and the first and last that are kept. */
export interface Cut {
  above: number
  from: number
  to: number
}
/** A fit of a recording, in its folder; `device`: the structure, where that is one. A cut is a file of its own beside it. */
export function fitLine(file: string, options: Options, device: string | null, cut: Cut | null): string {
  const inFolder = (name: string): string => quoted(name.startsWith('-') ? `./${name}` : name)
  const used = cut ? file.replace(/(\.\w+)?$/, (end) => `_cut${end}`) : file
  const lines = cut && (cut.above > 0 ? `1,${cut.above}p;` : '') + `${cut.from},${cut.to}p`
  const made = cut ? `sed -n '${lines}' ${inFolder(file)} > ${inFolder(used)} && ` : ''
  const line = `${made}${['zwidth identify', inFolder(used), ...optionsText(options)].join(' ')}`
  return device === null ? line : withDevice(`${line} --structure -`, device)
}

/** A study with its file made before it, in any folder. */
export function studyLine(study: string, options: Options): string {
  const name = 'study.toml'
  const made = withDevice(`cat > ${name}`, study)
  return `${made}\n${commandLine('study', { study: name, ...options })}`
}

/** The line, with a device for its standard input. */
function withDevice(line: string, text: string): string {
  if (hasControls(text)) return `printf '${printfFormat(text)}' | ${line}`
  const lines = new Set(text.split('\n'))
  const end = unused('END_OF_DEVICE', (each) => !lines.has(each))
  return `${line} <<'${end}'\n${text.replace(/\n*$/, '\n')}${end}`
}

/** The text's own end of a raw string must not occur in it. */
export function cppCode(toml = workbench.toml): string {
  const end = unused('toml', (each) => !toml.includes(`)${each}"`))
  return `#include <iomanip>
#include <iostream>
#include <string>
#include <zwidth/zwidth.hpp>

int main() {
  const auto device = zwidth::parse_device(R"${end}(${toml})${end}", "workbench");
  if (!device) {
    std::cerr << device.error().what << '\\n';
    return 2;
  }
  const zwidth::Analysis analysis = zwidth::analyze(*device);
  for (const std::string& reason : analysis.trust.reasons) {
    std::cerr << (analysis.trust.refused() ? "refused: " : "doubtful: ") << reason << '\\n';
  }
  if (analysis.trust.refused()) {
    return 1;
  }
  std::cout << std::setprecision(17) << analysis.critical.stiffness << '\\n';  // infinite: every wall is stable
}
`
}

export function pythonCode(toml = workbench.toml): string {
  const escape = (quotes: string): string => quotes.replaceAll('"', '\\"')
  const text = toml
    .replaceAll('\\', '\\\\')
    .replace(/"{3,}|"+$/g, escape)
    .replace(/[\u0000\r]/g, (c) => (c === '\r' ? '\\r' : '\\x00'))
  // One line alone would be the name of a file.
  return `import zwidth

device = zwidth.Device.from_toml("""\\
${text.includes('\n') ? text : `${text}\n`}""")
analysis = zwidth.analyze(device)
print(analysis.critical_stiffness, analysis.units.stiffness, analysis.trust.verdict)
`
}
