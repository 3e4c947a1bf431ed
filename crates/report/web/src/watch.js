// A page of a folder loads itself again when a file there changes.

const EVERY_MS = 1500;

export function watch() {
  let known;
  const look = async () => {
    try {
      const stamp = await (await fetch("stamp")).text();
      if (known !== undefined && stamp !== known) location.reload();
      known = stamp;
    } catch {
      // the server is gone: what is shown stays
    }
    setTimeout(look, EVERY_MS);
  };
  look();
}
