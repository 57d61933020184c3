/** Receives the server's sound beside the page's own thread, which may be busy drawing. */

const AGAIN_MS = 500;

self.onmessage = ({ data: { url, port } }) => {
  const open = () => {
    const socket = new WebSocket(url);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => {
      const [frame] = new Float64Array(data, 0, 1);
      const samples = new Float32Array(data, 8);
      port.postMessage({ frame, samples }, [data]);
    };
    socket.onclose = () => setTimeout(open, AGAIN_MS);
  };
  open();
};
