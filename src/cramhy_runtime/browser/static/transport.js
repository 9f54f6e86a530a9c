// How the page reaches its session: by a port to the worker, which looks to `connection.js` like a WebSocket.

import { tab } from "./tab.js";

export const url = "worker:///";
export const token = "of this tab";
export const ready = new Promise((resolve) => tab.whenReady(resolve));

export function make() {
  const { port1, port2 } = new MessageChannel();
  const socket = {
    onopen: null,
    onmessage: null,
    onclose: null,
    send: (text) => port1.postMessage(text),
    close() {
      port1.close();
      tab.leave(socket);
    },
  };
  port1.onmessage = ({ data }) => socket.onmessage?.({ data });
  tab.join(socket, port2);
  return socket;
}
