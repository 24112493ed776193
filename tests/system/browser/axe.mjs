// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs axe, which checks the accessibility of the page in its present state.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** Returns {violations, passes}: ids of rules, violations with the elements. */
export async function audit(page) {
  await page.evaluate(axe);
  const { violations, passes } = await page.evaluate(() => window.axe.run());
  const name = ({ id, nodes }) => `${id}: ${nodes.map((node) => node.target).join(' ')}`;
  return { violations: violations.map(name), passes: passes.map(({ id }) => id) };
}
