// SPDX-License-Identifier: LGPL-2.1-or-later
// Builds the page into dist/, whose files are committed. Their names have no hashes, and there are
// no source maps.
import { readFileSync } from 'node:fs';
import { defineConfig } from 'vite';

const text = (path) => readFileSync(new URL(path, import.meta.url), 'utf8');
const draco = './node_modules/three/examples/jsm/libs/draco/';
const licensed = ['three', 'uplot', '@foxglove/ws-protocol', 'eventemitter3', 'debug', 'ms'];

/** Adds files that are copied without changes: the Draco worker, its decoder, and licences. */
function plainFiles() {
  const licenses = () =>
    licensed
      .map((name) => {
        const pack = JSON.parse(text(`./node_modules/${name}/package.json`));
        const file = ['LICENSE', 'LICENSE.md', 'license.md'].find((f) => {
          try {
            return text(`./node_modules/${name}/${f}`);
          } catch {
            return false;
          }
        });
        const terms = file ? text(`./node_modules/${name}/${file}`) : `Licence: ${pack.license}`;
        return `${name} ${pack.version}\n\n${terms.trim()}\n`;
      })
      .concat(['Draco decoder\n\nCopyright The Draco Authors. Licence: Apache-2.0,\nhttps://www.apache.org/licenses/LICENSE-2.0\n'])
      .join(`\n${'-'.repeat(72)}\n\n`);
  return {
    name: 'plain-files',
    generateBundle() {
      const emit = (fileName, source) => this.emitFile({ type: 'asset', fileName, source });
      emit('draco_worker.js', text('./src/draco_worker.js'));
      emit('draco_wasm_wrapper.js', text(`${draco}draco_wasm_wrapper.js`));
      emit('draco_decoder.wasm', readFileSync(new URL(`${draco}draco_decoder.wasm`, import.meta.url)));
      emit('licenses.txt', licenses());
    },
  };
}

export default defineConfig({
  base: './',
  plugins: [plainFiles()],
  worker: { format: 'es', rollupOptions: { output: { entryFileNames: 'slice_worker.js' } } },
  build: {
    target: 'es2020',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1000,
    rollupOptions: {
      output: {
        entryFileNames: 'page.js',
        assetFileNames: (asset) => (asset.names?.[0]?.endsWith('.css') ? 'page.css' : '[name][extname]'),
        inlineDynamicImports: true,
      },
    },
  },
});
