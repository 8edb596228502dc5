// What several panels show, and documents of the pinned designs.

import { workbench } from '../model/workbench.svelte'
import { Answer, once, type Options } from './answer.svelte'
import type { Analysis, Design, Example } from './documents'

export const analysis = new Answer<Analysis>()
export const design = new Answer<Design>(true)
export const examples = $state<{ list: Example[] }>({ list: [] })

export interface OfPin<T> {
  name: string
  document: T
}

/** The same document of every pinned design; none while the options are null. Called while a component is set up. */
export function ofPins<T>(path: string, options: () => Options | null = () => ({})): { readonly list: OfPin<T>[] } {
  let list = $state.raw<OfPin<T>[]>([])
  $effect(() => {
    const asked = options()
    if (asked === null) return
    let current = true
    const all = workbench.pins.map((pin) =>
      once<T>({ path, toml: pin.toml, options: asked }).then(
        (document) => ({ name: pin.name, document }),
        () => null,
      ),
    )
    void Promise.all(all).then((found) => {
      if (current) list = found.filter((each) => each !== null)
    })
    return () => {
      current = false
    }
  })
  return {
    get list() {
      return list
    },
  }
}
