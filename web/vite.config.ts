import react from '@vitejs/plugin-react';
import { defineConfig } from 'vitest/config';

// What is large and only some pages need gets its own file, loaded with those pages.
const lazyLibraries = ['three', 'uplot', '@xyflow', '@dagrejs'];

export default defineConfig({
  plugins: [react()],
  build: {
    // CMake asks for build/PRESET/web.
    outDir: process.env.VS_WEB_OUT ?? 'dist',
    emptyOutDir: true,
    target: 'es2023',
    rolldownOptions: {
      output: {
        codeSplitting: {
          groups: lazyLibraries.map((name) => ({
            name: name.replace('@', ''),
            test: new RegExp(`node_modules/${name}/`),
          })),
        },
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
