// A page with a question in each panel, and the number whose slider is drawn.
import type { Page } from 'playwright-core'
import { expect } from 'vitest'
import { askAll, openPage, place, row, settled, withWall } from './program'

export const here = place('devices/lhifam.toml')
export const key = 'body.handle.damping'
export const opened = async (): Promise<{ page: Page; end: () => Promise<void> }> => {
  const { page, context, complaints } = await openPage(here, 1280)
  await withWall(page)
  await askAll(page)
  await row(page, key).scrollIntoViewIfNeeded()
  await settled(page)
  return {
    page,
    end: async () => {
      await settled(page)
      expect(complaints).toEqual([])
      await context.close()
    },
  }
}
