// Even steps of colour that are seen as even, in grey too (viridis, Smith and van der Walt), as the program's own figures have them.

const stops = ['#440154', '#482878', '#3e4989', '#31688e', '#26828e', '#1f9e89', '#35b779', '#6ece58', '#b5de2b', '#fde725']
const parts = stops.map((stop) => [1, 3, 5].map((i) => Number.parseInt(stop.slice(i, i + 2), 16)))

/** Of a share from 0 to 1. */
export function colourOf(share: number): string {
  const at = Math.min(1, Math.max(0, share)) * (stops.length - 1)
  const below = Math.min(stops.length - 2, Math.floor(at))
  const mixed = parts[below]!.map((part, i) => Math.round(part + (at - below) * (parts[below + 1]![i]! - part)))
  return `rgb(${mixed.join(' ')})`
}
export const colourStops = stops.map((colour, i) => ({ colour, share: i / (stops.length - 1) }))
