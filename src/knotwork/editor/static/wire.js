// The line to the server: every message gets its answer; what was not answered is said again when the line is back.

/** @typedef {Record<string, any>} Message */

export class Wire {
  /**
   * @param {string} token  what lets this page in
   * @param {(news: Message) => void} hear  takes what the server says on its own
   * @param {(state: "open" | "lost") => void} tell  is told how the line is
   */
  constructor(token, hear, tell) {
    this.token = token;
    this.hear = hear;
    this.tell = tell;
    this.number = 0;
    this.wait = 250;
    /** @type {Map<number, {message: Message, resolve: (answer: Message) => void, see: (picture: Message) => void}>} */
    this.open = new Map();
    /** @type {string | null} */
    this.document = null;
    this.connect();
  }

  connect() {
    const socket = new WebSocket(`ws://${location.host}/socket?token=${encodeURIComponent(this.token)}`);
    this.socket = socket;
    socket.onmessage = (event) => this.receive(JSON.parse(event.data));
    socket.onclose = () => {
      this.tell("lost");
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(4000, this.wait * 1.6);
    };
  }

  /** @param {Message} message */
  receive(message) {
    if (message.hello) {
      this.wait = 250;
      this.tell("open");
      if (this.document) this.transmit({ id: 0, open: this.document });
      for (const [id, { message: again }] of this.open) this.transmit({ id, ...again });
    }
    if (message.picture) return this.open.get(message.picture)?.see(message);
    const asked = this.open.get(message.id);
    if (asked) {
      this.open.delete(message.id);
      asked.resolve(message);
    } else this.hear(message);
  }

  /** @param {Message} message */
  transmit(message) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /**
   * Say something, and wait for the answer.
   * @param {Message} message
   * @param {(picture: Message) => void} [see]  takes what the drawing will be, before it is on disk
   * @returns {Promise<Message>}
   */
  ask(message, see = () => {}) {
    const id = ++this.number;
    const said = message.do ? { ...message, key: `${PAGE}-${id}` } : message;
    return new Promise((resolve) => {
      this.open.set(id, { message: said, resolve, see });
      this.transmit({ id, ...said });
    });
  }
}

const PAGE = [...crypto.getRandomValues(new Uint8Array(12))].map((x) => x.toString(16).padStart(2, "0")).join("");
