// The wall that the page begins with, to be dragged from there.
import { tick } from 'svelte'
import type { Analysis } from '../api/documents'
import { tomlOfNumber } from '../model/decimal'
import { workbench } from '../model/workbench.svelte'

/** The limit for any passive user, else alone, with its first two digits: not above it. */
export function firstStiffness(of: Analysis | null): number {
  const limit = of?.point_wall?.any_user?.at_least || of?.any_user?.critical_stiffness || of?.critical_stiffness || 1
  const step = 10 ** (Math.floor(Math.log10(limit)) - 1)
  return Number((Math.floor(limit / step) * step).toPrecision(2))
}

/** Puts it into the file, and the keyboard on its handle. */
export async function putWall(stiffness: number): Promise<void> {
  workbench.edit({ 'wall.stiffness': tomlOfNumber(stiffness) })
  for (let i = 0; i < 50; ++i) {
    await tick()
    await new Promise((done) => setTimeout(done, 20))
    const handle = document.querySelector<SVGGElement>('#panel-bar .handle')
    if (handle) return handle.focus()
  }
}
