/** The server's HTTP interface. Every address is relative to the page: nothing else is ever asked. */

/** What the server refused, in its own words. */
export class Refusal extends Error {
  override name = 'Refusal';
  constructor(
    message: string,
    readonly help: string | null = null,
  ) {
    super(message);
  }
}

/** What to tell of an error. */
export function words(error: unknown): string {
  if (error instanceof Refusal && error.help) return `${sentence(error.message)} ${sentence(error.help)}`;
  return error instanceof Error ? error.message : String(error);
}

function sentence(text: string): string {
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}${text.endsWith('.') ? '' : '.'}`;
}

/** Asks for JSON. */
export async function json<Answer>(path: string): Promise<Answer> {
  const response = await ask(path, {});
  return (await response.json()) as Answer;
}

/** Asks for bytes. */
export async function bytes(path: string, signal?: AbortSignal): Promise<ArrayBuffer> {
  const response = await ask(path, signal ? { signal } : {});
  return response.arrayBuffer();
}

/** Tells the server to do something. */
export async function post(path: string, body: unknown = {}): Promise<void> {
  const headers = { 'content-type': 'application/json' };
  await ask(path, { method: 'POST', headers, body: JSON.stringify(body) });
}

async function ask(path: string, options: RequestInit): Promise<Response> {
  const response = await fetch(path, options);
  if (!response.ok) throw await refusal(response);
  return response;
}

async function refusal(response: Response): Promise<Refusal> {
  const fallback = `${response.status} ${response.statusText}`.trim();
  try {
    const { error, help } = (await response.json()) as { error?: string; help?: string };
    return new Refusal(error ?? fallback, help ?? null);
  } catch {
    return new Refusal(fallback);
  }
}
