// A figure as SVG, PNG or CSV, as a download.

export interface Table {
  head: string[]
  rows: (string | number | null)[][]
}

const kept = [
  'fill',
  'stroke',
  'stroke-width',
  'stroke-dasharray',
  'stroke-linejoin',
  'opacity',
  'fill-opacity',
  'font-size',
  'font-weight',
  'font-family',
  'text-anchor',
  'dominant-baseline',
  'paint-order',
]

/** The figure for paper: in the light colours, whichever the page has, with its title above and its legend below. */
function standalone(svg: SVGSVGElement, title: string): Drawn {
  const page = document.documentElement.dataset
  const before = page.theme
  page.theme = 'light'
  try {
    return drawn(svg, title)
  } finally {
    if (before === undefined) delete page.theme
    else page.theme = before
  }
}

interface Drawn {
  text: string
  width: number
  height: number
}
const titleHeight = 24

/** As it looks, without the page's style sheet. */
function drawn(svg: SVGSVGElement, title: string): Drawn {
  const copy = svg.cloneNode(true) as SVGSVGElement
  const from = svg.querySelectorAll<SVGElement>('*')
  copy.querySelectorAll<SVGElement>('*').forEach((element, i) => {
    const style = getComputedStyle(from[i]!)
    for (const name of kept) {
      const value = style.getPropertyValue(name)
      if (value) element.setAttribute(name, value)
    }
    if (style.display === 'none') element.setAttribute('display', 'none')
    for (const name of ['class', 'style', 'tabindex', 'role']) element.removeAttribute(name)
  })
  const { width, height: plot } = svg.getBoundingClientRect()
  const height = titleHeight + plot + legend(svg, copy, plot)
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg')
  copy.setAttribute('width', String(width))
  copy.setAttribute('height', String(height))
  copy.setAttribute('viewBox', `0 ${-titleHeight} ${width} ${height}`)
  copy.append(
    textOf(title, { x: 4, y: 16 - titleHeight, fill: getComputedStyle(document.body).color, 'font-size': 13, 'font-weight': 600 }),
  )
  const ground = document.createElementNS('http://www.w3.org/2000/svg', 'rect')
  ground.setAttribute('y', String(-titleHeight))
  ground.setAttribute('width', '100%')
  ground.setAttribute('height', '100%')
  ground.setAttribute('fill', getComputedStyle(document.body).backgroundColor)
  copy.prepend(ground)
  return { text: new XMLSerializer().serializeToString(copy), width, height }
}

function textOf(content: string, attributes: Record<string, string | number>): SVGTextElement {
  const text = document.createElementNS('http://www.w3.org/2000/svg', 'text')
  for (const [name, value] of Object.entries({ 'font-family': 'system-ui, sans-serif', ...attributes }))
    text.setAttribute(name, String(value))
  text.textContent = content
  return text
}

/** The names of the curves, which stand beside the figure on the page, below it; returns how high they are. */
function legend(svg: SVGSVGElement, copy: SVGSVGElement, top: number): number {
  const items = [...(svg.closest('figure')?.querySelectorAll('.legend li') ?? [])]
  const color = getComputedStyle(document.body).color
  items.forEach((item, i) => {
    const [x, y] = [60 + (i % 3) * 200, top + 14 + Math.floor(i / 3) * 18]
    const line = item.querySelector('line')
    const sample = document.createElementNS('http://www.w3.org/2000/svg', 'path')
    sample.setAttribute('d', `M${x} ${y}h26`)
    for (const name of ['stroke', 'stroke-width', 'stroke-dasharray'])
      sample.setAttribute(name, line ? getComputedStyle(line).getPropertyValue(name) : color)
    copy.append(sample, textOf(item.textContent ?? '', { x: x + 32, y: y + 4, fill: color, 'font-size': 12 }))
  })
  return items.length > 0 ? 10 + 18 * Math.ceil(items.length / 3) : 0
}

export function download(name: string, content: Blob): void {
  const link = document.createElement('a')
  link.href = URL.createObjectURL(content)
  link.download = name
  link.click()
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000)
}

export function saveSvg(svg: SVGSVGElement, name: string, title: string): void {
  download(`${name}.svg`, new Blob([standalone(svg, title).text], { type: 'image/svg+xml' }))
}

export async function savePng(svg: SVGSVGElement, name: string, title: string): Promise<void> {
  const { text, width, height } = standalone(svg, title)
  const image = new Image()
  image.src = URL.createObjectURL(new Blob([text], { type: 'image/svg+xml' }))
  await image.decode()
  const canvas = document.createElement('canvas')
  canvas.width = width * 2
  canvas.height = height * 2
  canvas.getContext('2d')!.drawImage(image, 0, 0, canvas.width, canvas.height)
  URL.revokeObjectURL(image.src)
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, 'image/png'))
  if (blob) download(`${name}.png`, blob)
}

export function csvOf({ head, rows }: Table): string {
  const cell = (value: string | number | null): string => {
    const text = value === null ? '' : String(value)
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text
  }
  return [head, ...rows].map((row) => row.map(cell).join(',')).join('\n') + '\n'
}

export function saveCsv(table: Table, name: string): void {
  download(`${name}.csv`, new Blob([csvOf(table)], { type: 'text/csv' }))
}

export const fileName = (text: string): string =>
  text
    .toLowerCase()
    .replace(/[^\p{L}\p{N}]+/gu, '_')
    .replace(/^_|_$/g, '') || 'figure'
