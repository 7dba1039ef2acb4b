/** Tells listeners that something has changed. */
export class Signal {
  private readonly listeners = new Set<() => void>();

  /** The answer ends it. */
  readonly on = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => {
      this.listeners.delete(listener);
    };
  };

  emit(): void {
    for (const listener of this.listeners) listener();
  }
}
