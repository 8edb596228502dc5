import { tick } from 'svelte'
import { fullKey, sameKey } from '../model/keys'
import { assumedKeys } from '../model/parts'
import { workbench } from '../model/workbench.svelte'

/** Which panels are open; the palette opens them too. */
export const panels = $state<Record<string, boolean>>({})

export const panelNames: [id: string, title: string][] = [
  ['bar', 'Which stiffness is stable'],
  ['workspace', 'Where in the workspace'],
  ['limits', 'What limits, what to change'],
  ['recommend', 'Which wall to render'],
  ['region', 'Stiff and damped walls'],
  ['time', 'The wall hit in time'],
  ['bode', 'Frequency response'],
  ['sweep', 'Follow one number'],
  ['diagnose', 'What is this buzz?'],
  ['relay', 'Relay experiment'],
  ['recording', 'From a recording to a device'],
  ['compare', 'Pinned designs'],
  ['file', 'Device file and commands'],
]

/** A line of the device file, selected in its panel. */
export function showLine(line: number): void {
  panels.file = true
  setTimeout(() => {
    const field = document.querySelector<HTMLTextAreaElement>('#toml')
    if (!field) return
    const lines = field.value.split('\n')
    const start = lines.slice(0, line - 1).reduce((sum, each) => sum + each.length + 1, 0)
    field.scrollIntoView({ block: 'center' })
    field.focus()
    field.setSelectionRange(start, start + (lines[line - 1]?.length ?? 0))
  })
}

export function showPanel(id: string): void {
  panels[id] = true
  void tick().then(() => {
    const panel = document.getElementById(`panel-${id}`)
    if (!panel) return
    keepAtTop(panel)
    panel.querySelector<HTMLElement>('h2 button')?.focus()
  })
}

/** Its panel, for that number. */
export function sweepOver(key: string): void {
  workbench.setting('sweep', key)
  showPanel('sweep')
}

let shown = new AbortController()

/** Brings it to the top, and again as answers above it arrive, until somebody moves the page; for 5 s at most. */
function keepAtTop(panel: HTMLElement): void {
  shown.abort()
  const until = (shown = new AbortController())
  const grown = new ResizeObserver(() => panel.scrollIntoView({ block: 'start' }))
  grown.observe(document.body) // it is told at once, too
  until.signal.addEventListener('abort', () => grown.disconnect())
  for (const moved of ['wheel', 'touchstart', 'pointerdown', 'keydown']) {
    addEventListener(moved, () => until.abort(), { once: true, signal: until.signal })
  }
  setTimeout(() => until.abort(), 5_000)
}

/** The answer of another device, on top; the keyboard goes on from there, to its numbers. */
export function showAnswer(): void {
  const title = document.getElementById('answer-title')
  title?.scrollIntoView({ block: 'start' })
  title?.focus({ preventScroll: true })
}

/** That number's field, ready to be typed over. */
export function goTo(key: string): void {
  workbench.selected = workbench.groups.find((group) => group.rows.some((row) => sameKey(row.key, key)))?.id ?? ''
  void tick().then(() => document.querySelector<HTMLInputElement>(`[data-key="${CSS.escape(fullKey(key))}"] input`)?.focus())
}

/** A new device: its numbers are only to begin with, and one goes on with the first of them. */
export function beginWith(toml: string): void {
  workbench.load(toml)
  showAnswer()
  const [first] = assumedKeys(toml)
  if (first !== undefined) goTo(first)
}
