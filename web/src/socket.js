// The connection: one at a time, again after a while when it is lost.
import { parseFrame } from './protocol.js';

export class Socket {
  constructor(onFrame, onState) {
    this.onFrame = onFrame;
    this.onState = onState;
    this.wait = 500;
    this.open();
  }

  open() {
    const address = new URL('ws', location.href);
    address.protocol = 'ws:';
    address.search = location.search; // the token
    const socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.wait = 500;
      this.onState('open');
    };
    socket.onmessage = ({ data }) => {
      try {
        this.onFrame(parseFrame(data));
      } catch (error) {
        socket.close();
        this.onState('broken', error.message);
      }
    };
    socket.onclose = () => {
      this.onState('closed');
      setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(2 * this.wait, 8000);
    };
    this.socket = socket;
  }

  send(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(message);
  }
}
