// What stands beside a figure covers no text of it, and comes on hover and focus.
import { expect, it } from 'vitest'
import { openPage, place, settled, show, withWall } from './program'

const here = place('devices/lhifam.toml')

it.each([1440, 1024])('covers no text by the tools of a figure, %i pixels wide', async (width) => {
  const { page, context, complaints } = await openPage(here, width)
  await withWall(page)
  await settled(page)
  const opacity = (): Promise<string> => page.locator('#panel-bar .figure-tools').evaluate((each) => getComputedStyle(each).opacity)
  await page.mouse.move(5, 5)
  await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur())
  await expect.poll(opacity).toBe('0')
  await page.locator('#panel-bar svg').first().hover()
  await expect.poll(opacity).toBe('1')
  await page.mouse.move(5, 5)
  await page.locator('#panel-bar .handle').focus()
  await expect.poll(opacity).toBe('1')
  for (const tab of ['Wall', 'Frequency']) {
    await show(page, tab)
    await settled(page)
    const covered = await page.evaluate(() => {
      const tools = [...document.querySelectorAll('.figure-tools button')]
        .filter((each) => each.checkVisibility())
        .map((each) => ({ name: each.getAttribute('aria-label'), box: each.getBoundingClientRect() }))
      const walk = document.createTreeWalker(document.querySelector('main')!, NodeFilter.SHOW_TEXT)
      const found: string[] = []
      for (let node = walk.nextNode(); node; node = walk.nextNode()) {
        const parent = node.parentElement!
        // What scrolls below the answer is not below its tools.
        const isSeen = parent.checkVisibility() && !parent.closest('.figure-tools, .hidden, title')
        if (!node.textContent?.trim() || !isSeen || (parent.closest('.device, .sheets') && !parent.closest('figure'))) continue
        const range = document.createRange()
        range.selectNodeContents(node)
        for (const text of range.getClientRects())
          for (const { name, box } of tools)
            if (text.left < box.right - 1 && box.left < text.right - 1 && text.top < box.bottom - 1 && box.top < text.bottom - 1)
              found.push(`${name} over ${node.textContent.trim()}`)
      }
      return found
    })
    expect(covered, tab).toEqual([])
  }
  expect(complaints).toEqual([])
  await context.close()
})
