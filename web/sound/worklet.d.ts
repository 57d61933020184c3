/** What an audio worklet's own scope has, which TypeScript's library leaves out. */

declare class AudioWorkletProcessor {
  readonly port: MessagePort;
}

declare function registerProcessor(name: string, processor: unknown): void;

declare const sampleRate: number;
