import react from '@vitejs/plugin-react';
import { defineConfig } from 'vitest/config';

export default defineConfig({
  plugins: [react()],
  build: {
    // CMake asks for build/PRESET/web.
    outDir: process.env.VS_WEB_OUT ?? 'dist',
    emptyOutDir: true,
    target: 'es2023',
    rolldownOptions: {
      output: {
        // What every page needs in one file: fewer requests, and larger files are packed better.
        codeSplitting: { groups: [{ name: 'base', tags: ['$initial'] }] },
      },
    },
  },
  worker: { format: 'es' },
  test: {
    environment: 'jsdom',
    // A busy machine is no fault of the page.
    testTimeout: 60_000,
    setupFiles: ['src/test/setup.ts'],
    include: ['src/**/*.test.{ts,tsx}'],
  },
});
