// What the panels state and do, beside the program's documents.
import { readFileSync } from 'node:fs'
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { askAll, documentOf, nobody, onEachTab, openPage, place, row, runPalette, settled, show, toDevice, type, withWall } from './program'

const here = place('devices/quanser_torsion.toml')

interface Wall {
  stiffness: number
  damping: number
  filters: { frequency_hz: number; damping_ratio: number; depth: number }[]
}

it('takes the wall recommended with its notch in one step', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: which wall')
  await page.getByRole('button', { name: 'Use this wall: recommended' }).click()
  await settled(page)
  const asked = documentOf('design', 'devices/quanser_torsion.toml', '--recommend') as unknown as {
    wall: Wall
    margins: { gain_margin_db: number; phase_margin_rad: number }
  }
  await runPalette(page, 'show: device file')
  const toml = await page.locator('#toml').inputValue()
  const notch = asked.wall.filters[0]!
  for (const [key, value] of Object.entries({
    stiffness: asked.wall.stiffness,
    damping: asked.wall.damping,
    frequency_hz: notch.frequency_hz,
    damping_ratio: notch.damping_ratio,
    depth: notch.depth,
  })) {
    expect(toml).toMatch(new RegExp(`\n${key} = ${String(value).replace('.', '\\.')}\n`))
  }
  const margin = `${Number(asked.margins.gain_margin_db.toPrecision(3))} dB`
  await expect.poll(() => page.locator('[data-answer="wall"]').innerText()).toContain(margin)
  await page.getByRole('button', { name: 'Undo' }).click()
  await expect.poll(() => page.locator('#toml').inputValue()).not.toContain('notch')
  await expect
    .poll(() => row(page, 'wall.stiffness').locator('input[type="text"]').inputValue())
    .not.toContain(String(asked.wall.stiffness))
  expect(complaints).toEqual([])
  await context.close()
})

const replaceText = async (page: Page, change: (toml: string) => string): Promise<void> => {
  await page.locator('#toml').fill(change(await page.locator('#toml').inputValue()))
  await page.locator('#toml').blur()
}

it('shows no number of a device whose answer is refused, in no panel', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await withWall(page)
  await askAll(page)
  await page.setViewportSize({ width: 1280, height: 4000 }) // what is out of view waits
  await onEachTab(page, async () => {})
  const numbers = (): Promise<string[]> =>
    page.evaluate(() => {
      const parts = [
        '.answer dl',
        '.answer .wall-word',
        '.numbers .effect',
        ...['bar', 'limits', 'region', 'time', 'bode', 'recommend', 'sweep', 'diagnose', 'relay'].map((id) => `#body-${id}`),
      ]
      return parts.flatMap((part) =>
        [...document.querySelectorAll<HTMLElement>(part)]
          .filter((each) => /\d/.test(each.innerText) || each.querySelector('svg path.curve'))
          .map(() => part),
      )
    })
  await expect.poll(async () => (await numbers()).length).toBeGreaterThan(10)
  await show(page, 'File')
  await replaceText(page, (toml) => `${toml}\n[uncertainty]\nverdict = "refused"\nwarning = "the record was cut off"\n`)
  await page.waitForFunction(() => /refused/.test(document.querySelector('[data-answer="trust"]')?.textContent ?? ''))
  await onEachTab(page, async () => {})
  await expect.poll(() => numbers()).toEqual([])
  await expect.poll(() => page.locator('.answer').innerText()).toContain('the record was cut off')
  for (const panel of ['time', 'bode', 'relay'])
    await expect.poll(() => page.locator(`#body-${panel}`).innerText()).toMatch(/refused:.*cut off[^]*No number is given/)
  await page.getByRole('button', { name: 'Save the wall as C' }).click()
  await page.locator('#body-file .problem', { hasText: 'REFUSED' }).waitFor()
  expect(complaints).toEqual([])
  await context.close()
})

it('writes the wall of a doubtful device in C only when told to, and says so in the command', async () => {
  const { page, context } = await openPage(here, 1280)
  await withWall(page)
  await runPalette(page, 'show: device file')
  await replaceText(page, (toml) => `${toml}\n[uncertainty]\nverdict = "doubtful"\nwarning = "measured by a guess"\n`)
  await page.waitForFunction(() => /doubtful/.test(document.querySelector('[data-answer="trust"]')?.textContent ?? ''))
  await page.getByRole('button', { name: 'Save the wall as C' }).click()
  await page.locator('#body-file .problem', { hasText: 'the box above writes the wall all the same' }).waitFor()
  await page.getByLabel(/doubtful device all the same/).check()
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save the wall as C' }).click()])
  expect(readFileSync(await download.path(), 'utf8')).toContain('measured by a guess')
  await page.getByRole('button', { name: 'Copy the command for C' }).click()
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/^zwidth export .*--format c --accept-doubt/)
  await page.getByRole('button', { name: 'Copy as C++' }).click()
  await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toContain('analysis.trust.reasons')
  await context.close()
})

it('leads from an error of the text to its line', async () => {
  const { page, context } = await openPage(here, 1280)
  await runPalette(page, 'show: device file')
  const line = (await page.locator('#toml').inputValue()).split('\n').findIndex((each) => each.startsWith('[loop]')) + 1
  await replaceText(page, (toml) => toml.replace('\n[loop]', '\n[loop'))
  await page.locator('.answer .problem', { hasText: `Line ${line}, column` }).waitFor()
  await expect.poll(() => page.locator('#toml-problem').innerText()).toContain(`Line ${line}, column`)
  await expect.poll(() => page.locator('#toml').getAttribute('aria-invalid')).toBe('true')
  await page.getByRole('button', { name: 'Show the line' }).click()
  await page.waitForFunction(() => document.activeElement?.id === 'toml')
  await expect
    .poll(() => page.locator('#toml').evaluate((field: HTMLTextAreaElement) => field.value.slice(field.selectionStart, field.selectionEnd)))
    .toBe('[loop')
  await context.close()
})

it('adds, connects and removes parts by key, takes it back, and says what is wrong at its field', async () => {
  const { page, context, complaints } = await openPage(here, 390)
  const bodies = (): Promise<number> => page.locator('.schematic svg [aria-label^="Body"]').count()
  const before = await bodies()
  await page.getByText('Add, remove and connect parts').focus()
  await page.keyboard.press('Enter')
  await page.getByLabel('New body', { exact: true }).fill('tip')
  await page.keyboard.press('Enter')
  await settled(page)
  await expect.poll(() => bodies()).toBe(before + 1)
  await page.waitForSelector('[data-answer="nobody"]')
  await page.getByLabel('The hand holds').selectOption('tip')
  await settled(page)
  await expect.poll(() => page.locator('.schematic svg [aria-label="User at tip"]').count()).toBe(1)
  await page.getByLabel('Link 2, second body').selectOption({ index: 1 })
  await page.locator('#link-1-problem', { hasText: 'to itself' }).waitFor()
  await expect.poll(() => page.getByLabel('Link 2, second body').getAttribute('aria-invalid')).toBe('true')
  await page.keyboard.press('Control+z')
  await page.locator('.schematic svg [aria-label^="Link"]').last().focus()
  await page.keyboard.press('Delete')
  await page.locator('.parts .problem', { hasText: 'tied to nothing' }).waitFor()
  await page.keyboard.press('Control+z')
  await page.locator('.schematic svg [aria-label^="Body tip"]').focus()
  await page.keyboard.press('Delete')
  await settled(page)
  await expect.poll(() => bodies()).toBe(before)
  await page.waitForSelector('[data-answer="nobody"]')
  for (let i = 0; i < 3; ++i) await page.keyboard.press('Control+z')
  await expect.poll(() => bodies()).toBe(before)
  expect(complaints).toEqual([])
  await context.close()
})

it('shows warnings beside the wall, without a tick', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await withWall(page)
  await type(page, 'wall.stiffness', '1 N m/rad')
  await settled(page)
  await expect.poll(() => page.locator('[data-answer="wall"]').innerText()).toContain('✓')
  await expect.poll(() => page.locator('[data-answer="wall-warnings"]').count()).toBe(0)
  await type(page, 'wall.stiffness', '30.07 N m/rad') // stable alone, above the limit with any passive user
  await settled(page)
  await page.locator('[data-answer="wall-warnings"]', { hasText: 'any passive user' }).waitFor()
  await expect.poll(() => page.locator('[data-answer="wall"]').innerText()).toMatch(/^! The wall/)
  expect(complaints).toEqual([])
  await context.close()
})

it.each([1280, 390])('cuts no unit from a number, %i pixels wide', async (width) => {
  const { page, context, complaints } = await openPage(here, width)
  const digits = '1.23456789e-2'
  for (const key of ['loop.delay', 'wall.stiffness', 'wall.damping']) await type(page, key, digits)
  await runPalette(page, 'show: device file')
  await replaceText(page, (toml) => toml.replace(/^(inertia|damping|stiffness) = [^\n#]*/gm, `$1 = ${digits}`))
  await toDevice(page)
  const cut = await page
    .locator('.numbers input[type="text"]')
    .evaluateAll((all) => all.filter((each) => each.scrollWidth > each.clientWidth + 1).map((each) => (each as HTMLInputElement).value))
  expect(cut).toEqual([])
  expect(complaints).toEqual([])
  await context.close()
})

it('says what is missing in an empty device file, and keeps the panels', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: device file')
  await replaceText(page, () => '')
  await page.locator('.answer .problem', { hasText: 'The device file is empty' }).waitFor()
  await settled(page)
  await expect.poll(() => page.locator('.panel').count()).toBe(12)
  await expect.poll(() => page.locator('.schematic').innerText()).toContain('no bodies')
  await page.locator('.answer .problem').getByRole('button', { name: 'New, open' }).click()
  await page.locator('.examples button').first().click()
  await page.waitForSelector('[data-answer="nobody"]')
  for (const motion of ['linear', 'rotary']) {
    await page.getByRole('button', { name: 'New, open' }).click()
    await page.getByRole('button', { name: `New device, ${motion}` }).click()
    await settled(page)
    await expect.poll(() => page.locator('h1').innerText()).toBe('new device')
    await expect.poll(() => nobody(page)).toContain(motion === 'rotary' ? 'N m/rad' : 'N/m')
  }
  expect(complaints).toEqual([])
  await context.close()
})

it('opens the panel of the device file by its name, and downloads nothing', async () => {
  const { page, context } = await openPage(here, 1280)
  let downloads = 0
  page.on('download', () => ++downloads)
  await runPalette(page, 'Device file')
  await page.locator('#toml').waitFor()
  expect(downloads).toBe(0)
  await context.close()
})

it.each([1280, 390])('cuts no wall recommended, no label and no long name, %i pixels wide', async (width) => {
  const { page, context, complaints } = await openPage(here, width)
  await runPalette(page, 'show: which wall')
  await page.getByRole('button', { name: 'Use this wall: recommended' }).waitFor()
  await settled(page)
  const table = page.locator('#body-recommend .scroll-x')
  await expect.poll(() => table.evaluate((each) => each.scrollWidth - each.clientWidth)).toBeLessThanOrEqual(0)
  await expect.poll(() => table.innerText()).not.toContain('m^2')
  await runPalette(page, 'show: device file')
  await replaceText(page, (toml) =>
    toml.replace(/^name = .*/m, `name = "${'W'.repeat(200)}"`).replace(/^inertia = .*/m, 'inertia = "1234.5678 kg cm^2"'),
  )
  await settled(page)
  await expect
    .poll(() => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth))
    .toBeLessThanOrEqual(0)
  await expect.poll(() => page.locator('h1').evaluate((each) => each.scrollWidth - each.clientWidth)).toBeLessThanOrEqual(0)
  await toDevice(page)
  const outside = await page.locator('.schematic svg .part').evaluateAll((parts) =>
    parts.flatMap((part) => {
      const box = part.querySelector('rect.box')?.getBoundingClientRect()
      return box
        ? [...part.querySelectorAll('text')]
            .filter((text) => text.getBoundingClientRect().right > box.right || text.getBoundingClientRect().left < box.left)
            .map((text) => text.textContent)
        : []
    }),
  )
  expect(outside).toEqual([])
  expect(complaints).toEqual([])
  await context.close()
})
