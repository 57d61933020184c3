/**
 * A map that makes the values it does not have.
 * @template K, V
 * @extends {Map<K, V>}
 */
export class DefaultMap extends Map {
  #make;

  /** @param {() => V} make */
  constructor(make) {
    super();
    this.#make = make;
  }

  /**
   * The value of a key; made and kept where there was none.
   * @param {K} key
   * @returns {V}
   */
  at(key) {
    let value = this.get(key);
    if (value === undefined) {
      value = this.#make();
      this.set(key, value);
    }
    return value;
  }
}
