// Stands for the worker of a tab, without Python: it leads each port of the page to a socket of the fake session, whose address is its own.

const address = `ws://${location.host}/`;

onmessage = ({ data: { kind }, ports: [port] }) => {
  if (kind !== "port") return;
  const socket = new WebSocket(address);
  const early = [];
  port.onmessage = ({ data }) => (socket.readyState === WebSocket.OPEN ? socket.send(data) : early.push(data));
  socket.onopen = () => early.splice(0).forEach((text) => socket.send(text));
  socket.onmessage = ({ data }) => port.postMessage(data);
};

postMessage({ kind: "ready" });
