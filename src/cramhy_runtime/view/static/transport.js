// How the page reaches its session: by a WebSocket, to the server that it came from, with the token that stands in its address. The site
// that `cramhy browser` writes has another file in this one's place, for a session in a worker of the page's own.

export const url = `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/`;
export const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? location.hash.slice(1);
export const make = (address) => new WebSocket(address);
export const ready = Promise.resolve(); // when there is somebody to connect with
