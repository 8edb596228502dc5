// The documents that a panel shows: at most one request in flight, the newest wins, and what is late says so.

import { deviceKey } from '../model/keys'
import { held, stale } from '../model/words'
import { post, Problem } from './client'
import { breathe, changed, inTurn, untilRest } from './turns'

export type Options = Record<string, unknown>
/** Where what shows an answer stands: in view, further down, or on another tab. */
export type View = 'in' | 'out' | 'hidden'

export interface Question {
  path: string // analyze, design, ...
  toml?: string
  options?: Options
  more?: Record<string, unknown>
}

const textOf = ({ toml, options = {}, more = {} }: Question): string =>
  JSON.stringify({ ...(toml === undefined ? {} : { device_toml: toml }), ...more, options })

const restPause = 300 // ms, after which what nobody sees is asked
const noticed = 50 // ms
const firstPause = 1000 // ms, before a server that does not answer is asked again; then each twice as long
const longestPause = 30_000 // ms
const patience = 1000 // ms that work on something no longer asked may still take
const longWork = 500 // ms; whoever took longer is asked for its progress
export class Answer<T> {
  document = $state.raw<T | null>(null)
  problem = $state.raw<Problem | null>(null)
  /** Where the newest question has a mistake in it: the document before, of the same device. It is shown as such, dimmed. */
  before = $state.raw<T | null>(null)
  /** The document is not yet that of the newest question. */
  late = $state(false)
  /** What is shown has been of another question for so long that people see it; a panel says so. */
  lags = $state(false)
  private lagTimer: ReturnType<typeof setTimeout> | undefined
  /** What `document` answers. */
  question = $state.raw<Question | null>(null)

  private wanted: Question | null = null
  private wantedText = ''
  private shownText = ''
  private running = false
  private pause = firstPause
  private askedText = '' // of the request under way
  private replacedAt = 0 // when something newer than that was asked

  private view: View = 'in'
  private timer: ReturnType<typeof setTimeout> | undefined

  private progress = $state<number | null>(null)
  private abort: AbortController | null = null // of the request under way
  private begun = 0
  private took = 0
  private leaveTimer: ReturnType<typeof setTimeout> | undefined

  /** What a panel draws: a mistake in a number takes no picture away. */
  get drawn(): T | null {
    return this.document ?? this.before
  }
  /** Whether that is of other numbers than those that stand there. */
  get isStale(): boolean {
    return (this.lags && this.document !== null) || this.before !== null
  }

  /** What a panel says while what it shows is not what is asked. */
  get waits(): string {
    if (this.before) return held
    if (!this.lags) return ''
    return (this.document ? stale : 'computing …') + (this.progress === null ? '' : ` ${Math.floor(100 * this.progress)} %`)
  }

  /** `isSlow`: it may take long, and gives way to those that never do. */
  constructor(private readonly isSlow = false) {}

  /** What is out of view waits until the questions rest, what is on another tab until that is shown. */
  seen(view: View): void {
    this.view = view
    if (view === 'hidden') {
      clearTimeout(this.timer)
      this.timer = undefined
    } else if (this.late) this.startInView()
  }
  private startInView(): void {
    if (this.view === 'in') this.start()
    else if (this.view === 'out') this.startLater()
  }

  /** `since`: when what is shown ceased to be what is asked. */
  private setLate(late: boolean, since = performance.now()): void {
    this.late = late
    clearTimeout(this.lagTimer)
    const left = since + noticed - performance.now()
    this.lags = late && left <= 0
    if (late && left > 0) this.lagTimer = setTimeout(() => (this.lags = true), left)
  }
  private start(): void {
    clearTimeout(this.timer)
    this.timer = undefined
    if (!this.running) void this.run()
  }
  /** When nothing has been asked anywhere for a while; the timer that runs is kept, for a drag asks often. */
  private startLater(after = restPause): void {
    this.timer ??= setTimeout(() => {
      this.timer = undefined
      const left = untilRest(restPause)
      if (left > 1) this.startLater(left)
      else this.start()
    }, after)
  }

  ask(question: Question | null): void {
    const text = question === null ? '' : question.path + textOf(question)
    if (text === this.wantedText) return
    const before = this.wantedText
    const isOther = question === null || deviceKey(question.toml) !== deviceKey(this.wanted?.toml)
    this.wanted = question
    this.wantedText = text
    this.leave(isOther ? 0 : patience)
    changed()
    if (question === null) {
      this.document = null
      this.before = null
      this.problem = null
      this.question = null
      this.shownText = ''
      this.setLate(false)
    } else if (text === this.shownText) {
      this.setLate(false)
    } else {
      if (this.askedText !== text && this.askedText === before) this.replacedAt = performance.now()
      if (!this.late) this.setLate(true)
      // The picture of another device is no picture of this one, however shortly.
      if (this.question && deviceKey(this.question.toml) !== deviceKey(question.toml)) {
        this.document = null
        this.before = null
        this.problem = null
      }
      this.startInView()
    }
  }

  /** Gives up what is under way, as it is no longer asked; it may be done within that time. */
  private leave(within: number): void {
    clearTimeout(this.leaveTimer)
    if (this.askedText === this.wantedText) return
    const left = this.begun + within - performance.now()
    if (left <= 0) this.abort?.abort()
    else this.leaveTimer = setTimeout(() => this.askedText !== this.wantedText && this.abort?.abort(), left)
  }

  private async run(): Promise<void> {
    this.running = true
    for (let first = true; this.wanted !== null && this.wantedText !== this.shownText; first = false) {
      if (!first && this.view !== 'in') {
        this.startInView()
        break
      }
      let text = ''
      await inTurn(this.isSlow && this.took === 0 ? Infinity : this.isSlow ? this.took : 0, async () => {
        const question: Question | null = this.wanted
        text = this.wantedText
        if (question !== null) await this.once(question, text)
      })
      if (this.isSlow) await breathe(this.took)
      if (this.problem?.isPassing && this.wantedText === text) {
        this.timer = setTimeout(() => this.start(), this.pause)
        this.pause = Math.min(longestPause, 2 * this.pause)
        break
      }
    }
    this.running = false
  }

  private async once(question: Question, text: string): Promise<void> {
    let document: T | null = null
    let problem: Problem | null = null
    this.askedText = text
    this.begun = performance.now()
    const { signal } = (this.abort = new AbortController())
    try {
      document = await post<T>(question.path, textOf(question), {
        signal,
        told: this.isSlow || this.took > longWork ? (fraction) => (this.progress = fraction) : undefined,
      })
    } catch (error) {
      problem = error instanceof Problem ? error : new Problem('', String(error), '', 0)
    }
    this.abort = null
    this.progress = null
    this.took = performance.now() - this.begun
    clearTimeout(this.leaveTimer)
    if (signal.aborted) return
    if (this.wanted === null || deviceKey(question.toml) !== deviceKey(this.wanted.toml)) return
    if (problem?.isPassing) problem.again = Math.round(this.pause / 1000)
    else this.pause = firstPause
    this.shownText = problem?.isPassing ? '' : text // what may pass is asked again
    this.before = problem?.status === 400 ? (this.document ?? this.before) : null
    this.document = document
    this.problem = problem
    this.question = question
    this.setLate(text !== this.wantedText, this.replacedAt)
  }
}

/** The same question for designs that do not change: each is asked once. */
const kept = new Map<string, Promise<unknown>>()
export function once<T>(question: Question): Promise<T> {
  const text = question.path + textOf(question)
  const known = kept.get(text)
  if (known) return known as Promise<T>
  const asked = post<T>(question.path, textOf(question))
  kept.set(text, asked)
  asked.catch(() => kept.delete(text))
  if (kept.size > 100) kept.delete(kept.keys().next().value!)
  return asked
}
