// Reads particle files beside the page, with the same program.
import init, { read } from "./limpid.js";

const ready = init();
addEventListener("message", async ({ data: { name, bytes, options, isNew } }) => {
  await ready;
  try {
    const parts = read(name, bytes, options, isNew);
    postMessage({ parts }, parts.slice(1).map((column) => column.buffer));
  } catch (error) {
    // A program that has stopped has no more memory.
    postMessage({ problem: typeof error === "string" ? error : `${name}: cannot be read here (${error.message}); use limpid view` });
  }
});
