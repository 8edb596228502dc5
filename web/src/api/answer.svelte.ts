// The documents that a panel shows: at most one request in flight, the newest wins, and what is late says so.

import { deviceKey } from '../model/keys'
import { post, Problem } from './client'

export type Options = Record<string, unknown>

export interface Question {
  path: string // analyze, design, ...
  toml?: string
  options?: Options
  more?: Record<string, unknown>
}

const textOf = ({ toml, options = {}, more = {} }: Question): string =>
  JSON.stringify({ ...(toml === undefined ? {} : { device_toml: toml }), ...more, options })

// What takes long waits for its turn, so that the quick panels follow a drag: then one at a time, with pauses.
const mostTurns = 2
let turns = mostTurns
let lastChange = 0
const dragPause = 200 // ms
const untilRest = 300 // ms
const noticed = 150 // ms
const firstPause = 1000 // ms, before a server that does not answer is asked again; then each twice as long
const longestPause = 30_000 // ms
const waiting: (() => void)[] = []
async function turn(): Promise<void> {
  const most = performance.now() - lastChange < dragPause ? 1 : mostTurns
  if (turns > mostTurns - most) --turns
  else await new Promise<void>((resolve) => waiting.push(resolve))
}
async function endTurn(took: number): Promise<void> {
  if (performance.now() - lastChange < dragPause) await new Promise((resolve) => setTimeout(resolve, Math.min(1000, 3 * took)))
  ++turns
  const most = performance.now() - lastChange < dragPause ? 1 : mostTurns
  while (waiting.length > 0 && turns > mostTurns - most) {
    --turns
    waiting.shift()!()
  }
}

export class Answer<T> {
  document = $state.raw<T | null>(null)
  problem = $state.raw<Problem | null>(null)
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

  private isInView = true
  private timer: ReturnType<typeof setTimeout> | undefined

  constructor(private readonly isSlow = false) {}

  /** What nobody sees waits until the questions rest. */
  seen(inView: boolean): void {
    this.isInView = inView
    if (inView && this.late) this.start()
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
  private startLater(after = untilRest): void {
    this.timer ??= setTimeout(() => {
      this.timer = undefined
      const left = lastChange + untilRest - performance.now()
      if (left > 1) this.startLater(left)
      else this.start()
    }, after)
  }

  ask(question: Question | null): void {
    const text = question === null ? '' : question.path + textOf(question)
    if (text === this.wantedText) return
    const before = this.wantedText
    this.wanted = question
    this.wantedText = text
    lastChange = performance.now()
    if (question === null) {
      this.document = null
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
        this.problem = null
      }
      if (this.isInView) this.start()
      else this.startLater()
    }
  }

  private async run(): Promise<void> {
    this.running = true
    for (let first = true; this.wanted !== null && this.wantedText !== this.shownText; first = false) {
      if (!first && !this.isInView) {
        this.startLater()
        break
      }
      if (this.isSlow) await turn()
      const question: Question | null = this.wanted
      const text = this.wantedText
      const start = performance.now()
      if (question !== null) await this.once(question, text)
      if (this.isSlow) await endTurn(performance.now() - start)
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
    try {
      document = await post<T>(question.path, textOf(question))
    } catch (error) {
      problem = error instanceof Problem ? error : new Problem('', String(error), '', 0)
    }
    if (this.wanted === null || deviceKey(question.toml) !== deviceKey(this.wanted.toml)) return
    if (problem?.isPassing) problem.again = Math.round(this.pause / 1000)
    else this.pause = firstPause
    this.shownText = problem?.isPassing ? '' : text // what may pass is asked again
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
