// Which tab of the page is shown, and how one gets to a panel, a number or a line of the file.
import { tick } from 'svelte'
import { MediaQuery } from 'svelte/reactivity'
import { fullKey, sameKey } from '../model/keys'
import { assumedKeys } from '../model/parts'
import { workbench } from '../model/workbench.svelte'

/** Where the device does not stand beside the tabs, but is the first of them. */
export const narrow = new MediaQuery('max-width: 900px')

export const tabNames = {
  device: 'Device',
  wall: 'Wall',
  time: 'Time',
  frequency: 'Frequency',
  change: 'Change',
  recording: 'Recording',
  compare: 'Compare',
  study: 'Study',
  workspace: 'Workspace',
  file: 'File',
}
export type Tab = keyof typeof tabNames

export const panelNames: [id: string, title: string, tab: Tab][] = [
  ['region', 'Stiff and damped walls', 'wall'],
  ['recommend', 'Which wall to render', 'wall'],
  ['time', 'The wall hit in time', 'time'],
  ['diagnose', 'What is this buzz?', 'time'],
  ['bode', 'Frequency response', 'frequency'],
  ['relay', 'Relay experiment', 'frequency'],
  ['limits', 'What limits, what to change', 'change'],
  ['sweep', 'Follow one number', 'change'],
  ['recording', 'From a recording to a device', 'recording'],
  ['compare', 'Pinned designs', 'compare'],
  ['study', 'Many units of it', 'study'],
  ['workspace', 'Where in the workspace', 'workspace'],
  ['file', 'Device file and commands', 'file'],
]
export const titleOfPanel = (id: string): string => panelNames.find(([each]) => each === id)?.[1] ?? id
const tabOf = (id: string): Tab => panelNames.find(([each]) => each === id)?.[2] ?? 'wall'

class Desk {
  private chosen = $state<Tab>('device')
  /** Of those with plots, the one chosen last. */
  private beside = $state<Tab>('wall')
  tabs = $derived(
    (Object.keys(tabNames) as Tab[]).filter(
      (each) => (each !== 'device' || narrow.current) && (each !== 'workspace' || workbench.shape.mechanism !== null),
    ),
  )
  private wanted = $derived(narrow.current ? this.chosen : this.beside)
  tab: Tab = $derived(this.tabs.includes(this.wanted) ? this.wanted : 'wall')

  show(tab: Tab): void {
    this.chosen = tab
    if (tab !== 'device') this.beside = tab
  }
}
export const desk = new Desk()
/** Whether its panel is on the tab that is shown. */
export const isShown = (id: string): boolean => desk.tab === tabOf(id)

/** What is said on top of the page, until it is dismissed. */
export const notice = $state({ text: '' })

/** A line of the device file, selected in its panel. */
export function showLine(line: number): void {
  desk.show('file')
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
  desk.show(tabOf(id))
  void tick().then(() => {
    const panel = document.getElementById(`panel-${id}`)
    if (!panel) return
    keepAtTop(panel)
    panel.querySelector<HTMLElement>('h2')?.focus({ preventScroll: true })
  })
}

/** Its panel, for that number. */
export function sweepOver(key: string): void {
  workbench.setting('sweep', key)
  showPanel('sweep')
}

let shown = new AbortController()

/** Brings it to the top of its tab, and again as answers above it arrive, until somebody moves the page; for 5 s at most. */
function keepAtTop(panel: HTMLElement): void {
  shown.abort()
  const until = (shown = new AbortController())
  const grown = new ResizeObserver(() => panel.scrollIntoView({ block: 'start' }))
  for (const each of panel.parentElement?.children ?? []) grown.observe(each) // it is told at once, too
  until.signal.addEventListener('abort', () => grown.disconnect())
  for (const moved of ['wheel', 'touchstart', 'pointerdown', 'keydown']) {
    addEventListener(moved, () => until.abort(), { once: true, signal: until.signal })
  }
  setTimeout(() => until.abort(), 5_000)
}

/** Another device: the keyboard goes on from its answer, to its numbers. */
export function showAnswer(): void {
  desk.show('device')
  void tick().then(() => {
    document.getElementById('device')?.scrollTo({ top: 0 })
    document.getElementById('answer-title')?.focus({ preventScroll: true })
  })
}

/** The numbers of a part, on a narrow page their tab. */
export function select(group: string): void {
  workbench.selected = group
  desk.show('device')
}

/** That number's field, ready to be typed over. */
export function goTo(key: string): void {
  select(workbench.groups.find((group) => group.rows.some((row) => sameKey(row.key, key)))?.id ?? '')
  void tick().then(() => document.querySelector<HTMLInputElement>(`[data-key="${CSS.escape(fullKey(key))}"] input`)?.focus())
}

/** A new device: its numbers are only to begin with, and one goes on with the first of them. */
export function beginWith(toml: string): void {
  workbench.load(toml)
  showAnswer()
  const [first] = assumedKeys(toml)
  if (first !== undefined) void tick().then(() => goTo(first))
}
