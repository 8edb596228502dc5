// Every figure as SVG, PNG and CSV; the page as it is printed.
import { readFileSync } from 'node:fs'
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { askAll, openPage, place, project, settled, show, tabs, withWall } from './program'

const here = place('devices/lhifam.toml')

const unfold = async (page: Page): Promise<void> => {
  const folded = page.getByRole('button', { name: 'Save Which stiffness is stable', exact: true })
  if ((await folded.getAttribute('aria-expanded')) === 'false') await folded.click()
}
const saved = async (page: Page, label: string): Promise<Buffer> => {
  if (label.includes('Which stiffness')) await unfold(page)
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: label, exact: true }).click()])
  return readFileSync(await download.path())
}

/** Every figure in sight, looked at; their names. */
async function savesAll(page: Page): Promise<string[]> {
  await unfold(page)
  const buttons = await page
    .locator('.figure-tools button[aria-label^="Save"]:not([aria-expanded])')
    .evaluateAll((all) => all.filter((each) => each.checkVisibility()).map((each) => each.getAttribute('aria-label')!))
  const figures = buttons.flatMap((each) => /^Save (.*) as SVG$/.exec(each)?.[1] ?? [])
  // Every plot that is drawn has them.
  await expect
    .poll(() => page.locator('figure.plot').evaluateAll((all) => all.filter((each) => !each.querySelector('.figure-tools')).length))
    .toBe(0)
  for (const name of figures) {
    const svg = (await saved(page, `Save ${name} as SVG`)).toString('utf8')
    expect(svg, name).toMatch(/^<svg/)
    expect(svg, name).not.toContain('class=')
    const shown = await page.evaluate((text) => {
      const parsed = new DOMParser().parseFromString(text, 'image/svg+xml')
      return {
        problem: parsed.querySelector('parsererror')?.textContent,
        marks: parsed.querySelectorAll('path, rect, circle').length,
        texts: [...parsed.querySelectorAll('text')].map((each) => each.textContent),
      }
    }, svg)
    expect(shown.problem, name).toBeUndefined()
    expect(shown.marks, name).toBeGreaterThan(1)
    expect(shown.texts.length, name).toBeGreaterThan(3)
    expect(shown.texts).toContain(`LHIfAM, translational axis: ${name}`)
    expect(svg, name).toMatch(/<rect[^>]*fill="rgb\(255, 255, 255\)"/) // for paper, though the page is dark
    const png = await saved(page, `Save ${name} as PNG`)
    expect(png.subarray(1, 4).toString('latin1'), name).toBe('PNG')
    expect(png.length, name).toBeGreaterThan(1000)
  }
  for (const label of buttons.filter((each) => each.endsWith('as CSV'))) {
    const [head, ...lines] = (await saved(page, label)).toString('utf8').trim().split('\n')
    expect(head!.split(',').length, label).toBeGreaterThan(1)
    expect(lines.length, label).toBeGreaterThan(1)
    expect(
      lines.some((line) => /\d/.test(line)),
      label,
    ).toBe(true)
  }
  return figures
}

it('saves every figure as SVG, PNG and CSV, with what they show', async () => {
  const { page, context, complaints } = await openPage(here, 1280, '', 'dark')
  await withWall(page)
  await askAll(page)
  await page.getByRole('button', { name: 'Pin', exact: true }).click()
  await show(page, 'Recording')
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'Use this device' }).waitFor()
  await page.setViewportSize({ width: 1280, height: 4000 }) // what is out of view waits
  const all = new Set<string>()
  for (const tab of tabs) {
    await show(page, tab)
    await settled(page)
    for (const name of await savesAll(page)) all.add(name)
  }
  const figures = [...all]
  for (const name of [
    'Device',
    'Which stiffness is stable',
    'Stiff and damped walls',
    'Bode magnitude',
    'Bode phase',
    'Position over time',
    'Force over time',
    'Limits over delay',
    'Response, magnitude',
    'Response, phase',
    'Coherence',
  ]) {
    expect(figures).toContain(name)
  }
  await show(page, 'Wall')
  // The closing of an area along an axis is told from the limit.
  expect((await saved(page, 'Save the numbers of Stiff and damped walls as CSV')).toString('utf8')).toMatch(
    /^stable with nobody holding,oscillation,.*\n(.*\n)*stable with nobody holding,no damping,0,/m,
  )
  expect(complaints).toEqual([])
  await context.close()
})

it.each(['Wall', 'Frequency'])('prints the answer, its numbers and the tab %s, without what is only for the screen', async (tab) => {
  const { page, context, complaints } = await openPage(here, 1280, '', 'dark')
  await withWall(page)
  await askAll(page)
  await show(page, tab)
  await page.setViewportSize({ width: 1280, height: 4000 })
  await settled(page)
  await page.emulateMedia({ media: 'print' })
  await page.setViewportSize({ width: 718, height: 1000 }) // A4 less its margins
  await expect
    .poll(() => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth))
    .toBeLessThanOrEqual(0)
  const seen = async (selector: string): Promise<number> =>
    page.locator(selector).evaluateAll((all) => all.filter((each) => (each as HTMLElement).checkVisibility()).length)
  for (const selector of ['nav', 'input[type="range"]', '.figure-tools', '.row .icon', '.panel-body button.small'])
    await expect.poll(() => seen(selector), { message: selector }).toBe(0)
  for (const selector of [
    '[data-answer="nobody"]',
    '[data-answer="trust"]',
    '.numbers .row',
    ...(tab === 'Wall' ? ['#body-region svg', '#body-recommend table'] : ['#body-bode svg', '#body-relay table']),
  ])
    await expect.poll(() => seen(selector), { message: selector }).toBeGreaterThan(0)
  await expect.poll(() => page.evaluate(() => getComputedStyle(document.body).backgroundColor)).toBe('rgb(255, 255, 255)')
  const cut = await page
    .locator('.panel table, figure svg')
    .evaluateAll((all) =>
      all
        .filter((each) => each.getBoundingClientRect().right > document.documentElement.clientWidth + 1)
        .map((each) => each.closest('.panel')?.id),
    )
  expect(cut).toEqual([])
  const pdf = await page.pdf({
    format: 'A4',
    margin: { top: '10mm', bottom: '10mm', left: '10mm', right: '10mm' },
    ...(process.env.ZWIDTH_PDF ? { path: process.env.ZWIDTH_PDF } : {}),
  })
  expect(pdf.subarray(0, 4).toString('latin1')).toBe('%PDF')
  expect(complaints).toEqual([])
  await context.close()
})
