// Vitest runs the programs in jsdom, whose globals are not all Node.js's.

import { expect, test, vi } from "vitest";

import printed from "./printed.json";

test("the programs print what docs/wasm.md says", async () => {
  const log = vi.spyOn(console, "log").mockReturnValue();
  await import("./programs.mjs");
  expect(log.mock.calls.map(String)).toEqual(printed);
});
