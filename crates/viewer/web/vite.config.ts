import { loadEnv } from 'vite';
import { defineConfig } from 'vitest/config';

const env = loadEnv('', '.', 'POSEWIRE_');

/** Where `posewire view` listens while the page is developed with `npm run dev`. */
const server = env.POSEWIRE_VIEW ?? 'http://127.0.0.1:9780';

export default defineConfig({
  build: {
    outDir: env.POSEWIRE_WEB_OUT ?? 'dist',
    emptyOutDir: true,
    target: 'es2022',
    // No data: URLs, so that the page's content security policy needs none.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1500,
  },
  // The contrasts of the style are tested.
  test: { css: true },
  server: {
    host: '127.0.0.1',
    proxy: {
      '/api': { target: server, changeOrigin: true },
      '/ws': { target: server, changeOrigin: true, ws: true, rewriteWsOrigin: true },
    },
  },
});
