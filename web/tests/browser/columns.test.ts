// Recordings whose columns are not in SI units, and what must not break over lines or leave gaps.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { afterAll, expect, it } from 'vitest'
import { say } from '../../src/model/decimal'
import { addressOf, documentOf, openPage, place, project, row, runPalette, settled, type, withWall } from './program'

const folder = mkdtempSync(`${tmpdir()}/zwidth-`)
const here = place()
afterAll(() => rmSync(folder, { recursive: true }))

it('takes the unit of a column, to which the remark on counts leads', async () => {
  const file = `${folder}/counts.csv`
  // The position of the recording in whole steps of 2 um.
  const [head, ...lines] = readFileSync(`${project}/recordings/free_motion.csv`, 'utf8').trim().split('\n')
  const at = head!.split(',').indexOf('position')
  writeFileSync(
    file,
    [
      head,
      ...lines.map((line) =>
        line
          .split(',')
          .map((cell, i) => (i === at ? String(Math.round(Number(cell) / 2e-6)) : cell))
          .join(','),
      ),
    ].join('\n'),
  )
  const { page, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: from a recording')
  await page.getByLabel(/choose it/).setInputFiles(file)
  await page.getByLabel('Fit', { exact: true }).selectOption('rigid')
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'say what one of them is' }).click()
  await page.waitForFunction(() => document.activeElement?.id === 'scale-position')
  await page.keyboard.type('2 kg')
  await page.keyboard.press('Tab')
  await page.locator('#scale-position-problem', { hasText: 'kg' }).waitFor()
  await page.getByLabel('One unit of the position is').fill('2 um')
  await page.keyboard.press('Tab')
  await page.getByRole('button', { name: 'Use this device' }).waitFor()
  await settled(page)
  const fitted = documentOf(
    'identify',
    file,
    '--force',
    'force',
    '--position',
    'position',
    '--position-scale',
    '2e-6',
    '--structure',
    'rigid',
    '--motion',
    'linear',
  )
  await expect
    .poll(() => page.locator('#body-recording').innerText())
    .toContain(`The device fitted: critical stiffness ${say(Number(fitted.critical_stiffness), 'N/m')}`)
  expect(complaints).toEqual([])
  await page.context().close()
})

it.each([1280, 390])('breaks no number of a wall over lines, %i pixels wide', async (width) => {
  const { page, complaints } = await openPage(here, width)
  await runPalette(page, 'new motor and wheel, rotary')
  for (const [key, text] of [
    ['body.motor.mass', '1.2e-4'],
    ['body.motor.damping', '2e-3'],
    ['body.wheel.mass', '22 kg cm2'],
    ['link.0.stiffness', '900'],
    ['loop.delay', '0.2 ms'],
  ] as const)
    await type(page, key, text)
  await runPalette(page, 'go to encoder step')
  await page.keyboard.type('1 turn/10000')
  await page.keyboard.press('Enter')
  await runPalette(page, 'show: which wall')
  await page.getByRole('button', { name: 'Use this wall: recommended' }).waitFor()
  await settled(page)
  const broken = await page.locator('#body-recommend td:not(.words)').evaluateAll((cells) =>
    cells
      .filter((cell) => {
        const text = document.createRange()
        text.selectNodeContents(cell)
        return new Set([...text.getClientRects()].map((each) => Math.round(each.top))).size > 1
      })
      .map((cell) => cell.textContent),
  )
  expect(broken).toEqual([])
  await expect
    .poll(() => page.locator('#body-recommend .scroll-x').evaluate((each) => each.scrollWidth - each.clientWidth))
    .toBeLessThanOrEqual(0)
  expect(complaints).toEqual([])
  await page.context().close()
})

it('leaves no empty space at an unstable wall, and lets nothing jump while it is dragged', async () => {
  const { page, complaints } = await openPage(here, 390)
  await type(page, 'wall.stiffness', '3 kN/m')
  await settled(page)
  const word = page.locator('[data-answer="wall"]')
  const height = (): Promise<number> => page.locator('.answer-words').evaluate((each) => each.getBoundingClientRect().height)
  const stable = await height()
  const slider = row(page, 'wall.stiffness').locator('input[type="range"]')
  await slider.scrollIntoViewIfNeeded()
  const box = (await slider.boundingBox())!
  const y = box.y + box.height / 2
  await page.mouse.move(box.x + box.width / 2, y)
  await page.mouse.down()
  let least = Infinity
  for (let share = 0.5; share < 0.95; share += 0.05) {
    await page.mouse.move(box.x + share * box.width, y)
    await page.waitForTimeout(60)
    least = Math.min(least, await height())
  }
  await settled(page)
  await expect.poll(() => word.innerText()).toContain('unstable')
  expect(Math.min(least, await height())).toBeGreaterThanOrEqual(stable - 1)
  await page.mouse.up()
  await expect.poll(height).toBeLessThan(stable - 20)
  expect(complaints).toEqual([])
  await page.context().close()
})

it('takes a file that is dropped anywhere', async () => {
  const { page, complaints } = await openPage(here, 1280)
  const drop = (name: string, text: string): Promise<void> =>
    page.evaluate(
      ([name, text]) => {
        const dataTransfer = new DataTransfer()
        dataTransfer.items.add(new File([text!], name!))
        for (const type of ['dragover', 'drop']) {
          const event = new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true })
          document.querySelector('h1')!.dispatchEvent(event)
          if (!event.defaultPrevented) throw new Error(`${type}: the browser opens the file instead`)
        }
      },
      [name, text],
    )
  await drop('wheel.csv', 'time_s,torque_N_m,angle\n0,0,0\n0.001,1,0\n0.002,0,1e-6\n')
  await page.getByRole('button', { name: 'Fit', exact: true }).waitFor()
  await expect.poll(() => page.locator('#body-recording').innerText()).toContain('wheel.csv: text, 3 columns of 3 samples')
  await expect.poll(() => page.locator('#column-force').evaluate((each) => each.getBoundingClientRect().bottom < innerHeight)).toBe(true)
  expect([
    await page.getByLabel('Force (commanded)').inputValue(),
    await page.getByLabel('Position', { exact: true }).inputValue(),
    await page.getByLabel('Motion').inputValue(),
  ]).toEqual(['torque_N_m', 'angle', 'rotary'])
  await drop('mine.TOML', 'name = "dropped"\n[[body]]\nname = "a"\nmass = 1\n[loop]\nsampling_period = 1e-3\n')
  await page.getByRole('heading', { name: 'dropped' }).waitFor()
  expect(complaints).toEqual([])
  await page.context().close()
})

it('says that what it begins with is an example, and where one’s own begins', async () => {
  const { page, complaints } = await openPage(here, 390)
  await type(page, 'loop.delay', '0.1 ms')
  await settled(page)
  await page.locator('[data-answer="example"]').getByRole('button', { name: 'begin a new one' }).click()
  await page.getByRole('button', { name: 'New motor and wheel, rotary' }).click()
  await page.locator('[data-answer="assumed"]').waitFor()
  await expect.poll(() => page.locator('[data-answer="example"]').count()).toBe(0)
  expect(complaints).toEqual([])
  await page.context().close()
})

it('does not call a device sure whose numbers are assumed, in a link neither', async () => {
  const { page, complaints } = await openPage(here, 390)
  const trust = (): Promise<string> => page.locator('[data-answer="trust"]').innerText()
  await runPalette(page, 'new motor and wheel, rotary')
  const told = page.locator('[data-answer="assumed"]')
  await told.waitFor()
  await type(page, 'body.wheel.mass', '0.04 kg m^2')
  await settled(page)
  await expect
    .poll(() => told.innerText())
    .toContain('Body “motor”: inertia, damping; Link motor – wheel: stiffness, damping; Loop: sampling period.')
  await expect.poll(() => trust()).toBe('! doubtful')
  await expect.poll(() => row(page, 'loop.sampling_period').locator('input[type="text"]').inputValue()).toBe('1 ms')
  await type(page, 'loop.sampling_period', '1 ms') // the same, but said
  await expect.poll(() => told.innerText()).not.toContain('sampling period')
  await withWall(page)
  await settled(page)
  await expect.poll(() => page.locator('[data-answer="wall"]').innerText()).toMatch(/^!/)
  const shared = await openPage(here, 390, await addressOf(page))
  await shared.page.locator('[data-answer="assumed"]').waitFor()
  await expect.poll(() => shared.page.locator('[data-answer="trust"]').innerText()).toBe('! doubtful')
  await shared.context.close()
  await page.getByRole('button', { name: 'They are right' }).click()
  await told.waitFor({ state: 'detached' })
  await settled(page)
  await expect.poll(() => trust()).toBe('✓ sound')
  // No bar of an effect lies on its slider.
  const over = await page.locator('.row').evaluateAll(
    (rows) =>
      rows.filter((each) => {
        const [effect, slider] = [each.querySelector('.effect svg'), each.querySelector('input[type="range"]')]
        return (
          effect &&
          slider &&
          effect.getBoundingClientRect().left < slider.getBoundingClientRect().right &&
          effect.getBoundingClientRect().top < slider.getBoundingClientRect().bottom
        )
      }).length,
  )
  expect(over).toBe(0)
  expect(complaints).toEqual([])
  await page.context().close()
})

it('forgets with a new file what was said of the one before', async () => {
  const { page, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: from a recording')
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
  await page.getByLabel('One unit of the position is').fill('1 mm')
  await page.getByLabel('Samples per second').fill('2000')
  await page.getByLabel('Samples of a segment').fill('512')
  await page.getByLabel('handle', { exact: true }).check()
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/free_motion.csv`)
  await page.locator('#body-recording', { hasText: 'free_motion.csv: text' }).waitFor()
  const fields = ['One unit of the force is', 'One unit of the position is', 'Samples per second', 'Samples of a segment']
  await expect.poll(() => Promise.all(fields.map((each) => page.getByLabel(each).inputValue()))).toEqual(['', '', '', ''])
  await expect.poll(() => page.getByLabel('handle', { exact: true }).isChecked()).toBe(false)
  expect(complaints).toEqual([])
  await page.context().close()
})

it('reads a text as it is stated', async () => {
  const file = `${folder}/semicolons.csv`
  writeFileSync(file, readFileSync(`${project}/recordings/locked_chirp.csv`, 'utf8').replaceAll(',', ';').replaceAll('.', ','))
  const { page, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: from a recording')
  await page.getByLabel(/choose it/).setInputFiles(file)
  await page.getByText('How the file is read').click()
  const panel = page.locator('#body-recording')
  await page.getByLabel('Columns are separated by').selectOption('tab')
  await panel.locator('details [role="alert"]', { hasText: 'has no rows of numbers' }).waitFor()
  await page.getByLabel('Columns are separated by').selectOption('semicolon')
  await page.getByLabel('Decimal mark').selectOption('comma')
  await page.getByLabel('Names of the columns').selectOption('no-header')
  await expect.poll(() => page.getByLabel('Force (commanded)').locator('option').allInnerTexts()).toEqual(['choose', '1', '2', '3'])
  await page.getByLabel('Names of the columns').selectOption('header')
  await expect.poll(() => page.getByLabel('Force (commanded)').inputValue()).toBe('force')
  await page.getByLabel('Samples of a segment').fill('512')
  await page.getByLabel('handle', { exact: true }).check()
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'Use this device' }).waitFor()
  await settled(page)
  const stated = [
    '--delimiter',
    'semicolon',
    '--decimal',
    'comma',
    '--header',
    '--force',
    'force',
    '--position',
    'position',
    '--segment',
    '512',
  ]
  const fitted = documentOf('identify', file, ...stated, '--structure', 'two-body', '--motion', 'linear', '--locked', 'handle')
  const measured = documentOf('frf', file, ...stated)
  const shown = await panel.innerText()
  expect(shown).toContain(`The device fitted: critical stiffness ${say(Number(fitted.critical_stiffness), 'N/m')}`)
  expect(shown).toContain(`shows a critical stiffness of ${say(Number(measured.critical_stiffness), 'N/m')}`)
  expect(complaints).toEqual([])
  await page.context().close()
})

it('marks the page while a file is dragged over it', async () => {
  const { page, complaints } = await openPage(here, 1280)
  const drag = (type: string): Promise<void> =>
    page.evaluate((name) => {
      const dataTransfer = new DataTransfer()
      dataTransfer.items.add(new File(['x'], 'x.csv'))
      document.querySelector('h1')!.dispatchEvent(new DragEvent(name, { dataTransfer, bubbles: true, cancelable: true }))
    }, type)
  const mark = page.getByText('Drop a recording (CSV, MAT, UFF), a device file (TOML) or a mechanism (MJCF, URDF)')
  await expect.poll(() => mark.count()).toBe(0)
  await drag('dragover')
  await mark.waitFor()
  await drag('dragleave')
  await mark.waitFor({ state: 'detached' })
  await drag('dragover')
  await mark.waitFor()
  await drag('drop')
  await mark.waitFor({ state: 'detached' })
  expect(complaints).toEqual([])
  await page.context().close()
})

it('draws no label of a crossover over another, 390 pixels wide', async () => {
  const { page, complaints } = await openPage(here, 390)
  for (const delay of ['0', '0.5 ms', '1 ms']) {
    await type(page, 'loop.delay', delay)
    await runPalette(page, 'show: frequency response')
    await settled(page)
    const boxes = await page
      .locator('svg[aria-label="Bode magnitude"] g.mark text')
      .evaluateAll((all) => all.map((each) => each.getBoundingClientRect()))
    expect(boxes.length).toBeGreaterThan(1)
    for (const [i, a] of boxes.entries()) {
      for (const b of boxes.slice(i + 1))
        expect(a.left >= b.right || a.right <= b.left || a.top >= b.bottom || a.bottom <= b.top).toBe(true)
    }
  }
  expect(complaints).toEqual([])
  await page.context().close()
})
