// Links that hold code: `#code=1.CHECKSUM.TEXT`, where TEXT is a file's name and text as JSON, deflated, in base64url. Nobody is sent what
// stands behind the # of an address. The checksum tells of a link that a mail has cut short.

const VERSION = "1";
const MOST = 500_000; // bytes that a link may unpack to
const LONGEST = 60_000; // characters of a link, which browsers and mails still take

// A link that cannot be opened; the text says why.
export class UnfitLink extends Error {}

// What stands behind the # for a file.
export async function packed(path, text) {
  const bytes = await through(new TextEncoder().encode(JSON.stringify([path, text])), new CompressionStream("deflate-raw"), Infinity);
  const code = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  const plain = code.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  const link = `code=${VERSION}.${checksum(plain)}.${plain}`;
  if (link.length > LONGEST) throw new UnfitLink("This file is too long for a link. Export it as a package instead.");
  return link;
}

// {path, text} of what stands behind the #; null if that is no such link. Raises UnfitLink.
export async function unpacked(hash) {
  const found = /^#?code=(.*)$/s.exec(hash);
  if (!found) return null;
  const [version, sum, plain] = found[1].split(".");
  if (plain !== undefined && version !== VERSION) {
    throw new UnfitLink("This link was made by a newer version of this page. Load the page again.");
  }
  if (plain === undefined || checksum(plain) !== sum) {
    throw new UnfitLink("This link is not whole: a part of it is missing or was changed. Ask for it again, and copy all of it.");
  }
  try {
    const bytes = Uint8Array.from(atob(plain.replaceAll("-", "+").replaceAll("_", "/")), (each) => each.charCodeAt(0));
    const [path, text] = JSON.parse(new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw"), MOST)));
    if (typeof path !== "string" || typeof text !== "string") throw new Error("it holds no file");
    return { path: path.split("/").at(-1).replace(/[^\w.-]/g, "_") || "shared.lisp", text };
  } catch {
    throw new UnfitLink("This link cannot be opened: what it holds is no file of this page.");
  }
}

async function through(bytes, stream, most) {
  const reader = new Blob([bytes]).stream().pipeThrough(stream).getReader();
  const parts = [];
  let length = 0;
  for (let { done, value } = await reader.read(); !done; { done, value } = await reader.read()) {
    parts.push(value);
    length += value.length;
    if (length > most) {
      reader.cancel();
      throw new Error("it is too long");
    }
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

// FNV-1a, 32 bits, of a text.
function checksum(text) {
  let sum = 0x811c9dc5;
  for (let place = 0; place < text.length; place++) sum = Math.imul(sum ^ text.charCodeAt(place), 0x01000193);
  return (sum >>> 0).toString(36);
}
