// Who may ask when, so that the answer follows a drag and every panel in view follows as fast as it is itself.

const quick = 40 // ms; what takes less waits for nobody
const dragPause = 200 // ms
const atRest = 2 // of what takes longer, at once
// One of the machine's processors is left to the answer and one to the page.
const inDrag = Math.min(3, Math.max(1, ((globalThis.navigator as Navigator | undefined)?.hardwareConcurrency ?? 2) - 2))

let lastChange = -Infinity
let taken = 0
const waiting: (() => void)[] = []

/** Another question was asked, by anybody. */
export const changed = (): void => void (lastChange = performance.now())
/** How long it is until nothing was asked for `pause`; 0 or less: it rests. */
export const untilRest = (pause: number): number => lastChange + pause - performance.now()
const isDrag = (): boolean => untilRest(dragPause) > 0

function next(): void {
  while (waiting.length > 0 && taken < (isDrag() ? inDrag : atRest)) {
    ++taken
    waiting.shift()!()
  }
}

/** Waits for its turn where it takes long, as it did last time; then does it. Those wait in the order in which they came. */
export async function inTurn(took: number, work: () => Promise<void>): Promise<void> {
  if (took <= quick) return work()
  const turn = new Promise<void>((go) => waiting.push(go))
  next()
  await turn
  try {
    await work()
  } finally {
    --taken
    next()
  }
}

/** While something is dragged: as long as its answer took, in which others are asked. It ends where the drag does. */
export async function breathe(took: number): Promise<void> {
  for (const end = performance.now() + took; ; ) {
    const left = Math.min(end - performance.now(), untilRest(dragPause))
    if (left <= 0) return
    await new Promise((done) => setTimeout(done, left))
  }
}
