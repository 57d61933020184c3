/** Gets the instrument in WebAssembly, which a server may still be preparing. */

const PREPARING = 503;

/**
 * Throws an error that tells why there is none.
 * @param {() => void} waits called whenever it is still being prepared
 * @returns {Promise<ArrayBuffer>}
 */
export async function fetchModule(waits) {
  for (;;) {
    const answer = await fetch(new URL("../yehu.wasm", import.meta.url));
    if (answer.ok) return answer.arrayBuffer();
    const seconds = Number(answer.headers.get("Retry-After"));
    if (answer.status !== PREPARING || !seconds) throw new Error(await reasonOf(answer));
    waits();
    await new Promise((resolve) => setTimeout(resolve, 1e3 * seconds));
  }
}

/**
 * Why there is none: a server of this instrument tells, others have their own pages for that.
 * @param {Response} answer
 */
async function reasonOf(answer) {
  const isTold = answer.headers.get("Content-Type")?.startsWith("text/plain");
  return isTold ? (await answer.text()).trim() : `${answer.status} ${answer.statusText}`;
}
