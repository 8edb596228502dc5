/** What was, what is, and what was undone. Changes of one gesture (a drag) are one step. */
export class History<T> {
  private past: T[] = []
  private future: T[] = []
  private gesture: string | null = null

  constructor(
    private now: T,
    private readonly limit = 500,
  ) {}

  get current(): T {
    return this.now
  }
  get canUndo(): boolean {
    return this.past.length > 0
  }
  get canRedo(): boolean {
    return this.future.length > 0
  }

  change(next: T, gesture: string | null = null): void {
    if (gesture === null || gesture !== this.gesture) {
      this.past.push(this.now)
      if (this.past.length > this.limit) this.past.shift()
    }
    this.gesture = gesture
    this.future = []
    this.now = next
  }

  endGesture(): void {
    this.gesture = null
  }

  undo(): void {
    this.step(this.past, this.future)
  }

  redo(): void {
    this.step(this.future, this.past)
  }

  private step(from: T[], to: T[]): void {
    this.gesture = null
    const next = from.pop()
    if (next === undefined) return
    to.push(this.now)
    this.now = next
  }
}
