// Packed arrays back into typed arrays; the inverse of pack.py.

const KINDS = { u1: Uint8Array, u2: Uint16Array, u4: Uint32Array, f4: Float32Array, f8: Float64Array };

/** Typed array of one block. */
export async function unpack(block) {
  const packed = atob(document.getElementById(block.id).textContent);
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; i++) bytes[i] = packed.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const data = await new Response(stream).arrayBuffer();
  const Kind = KINDS[block.kind];
  return block.filtered ? unfiltered(new Uint8Array(data), new Kind(data.byteLength / Kind.BYTES_PER_ELEMENT), block) : new Kind(data);
}

/** Planes of bytes, folded differences of rows → words; typed arrays wrap around as the packer did. */
function unfiltered(planes, words, block) {
  const count = words.length;
  const width = words.BYTES_PER_ELEMENT;
  const row = block.shape[0] ? count / block.shape[0] : 1;
  for (let i = 0; i < count; i++) {
    let folded = 0;
    for (let b = 0; b < width; b++) folded |= planes[b * count + i] << (8 * b);
    const difference = (folded >>> 1) ^ -(folded & 1);
    words[i] = i < row ? difference : words[i - row] + difference;
  }
  return words;
}
