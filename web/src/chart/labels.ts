// Where the labels of marks stand: beside their marks, within the plot, and none over another.

export interface Place {
  x: number
  y: number // of the baseline
  anchor: 'start' | 'end'
}
interface Box {
  left: number
  right: number
  top: number
  bottom: number
}

const letter = 6.4 // pixels, about
const line = 13

/** Places of the texts at these points, in their order; null where none is left. */
export function placeLabels(points: { x: number; y: number; label: string }[], within: Box): (Place | null)[] {
  const taken: Box[] = points.map(({ x, y }) => ({ left: x - 5, right: x + 5, top: y - 5, bottom: y + 5 }))
  return points.map(({ x, y, label }, own) => {
    const width = label.length * letter
    const box = ({ x: at, y: base, anchor }: Place): Box => ({
      left: anchor === 'start' ? at : at - width,
      right: anchor === 'start' ? at + width : at,
      top: base - line + 3,
      bottom: base + 3,
    })
    const place = [-6, 14, -6 - line, 14 + line]
      .flatMap((dy): Place[] => [
        { x: x + 7, y: y + dy, anchor: 'start' },
        { x: x - 7, y: y + dy, anchor: 'end' },
      ])
      .find((each) => {
        const { left, right, top, bottom } = box(each)
        const isWithin = left >= within.left && right <= within.right && top >= within.top && bottom <= within.bottom
        return (
          isWithin &&
          taken.every((other, i) => i === own || left >= other.right || right <= other.left || top >= other.bottom || bottom <= other.top)
        )
      })
    if (!place) return null
    taken.push(box(place))
    return place
  })
}
