// SPDX-License-Identifier: Apache-2.0
// What is asked for once: GET, JSON. Promises the gateway's own words where it refuses.

export class Refusal extends Error {}

export async function get(path) {
  let answer;
  try {
    answer = await fetch(`api/v1/${path}`, { headers: { Accept: "application/json" }, cache: "no-store" });
  } catch {
    throw new Refusal("the gateway's web server does not answer");
  }
  let body = null;
  try {
    body = await answer.json();
  } catch { /* said below */ }
  if (!answer.ok) throw new Refusal(`${answer.status} ${body?.detail ?? body?.title ?? answer.statusText}`);
  if (body === null) throw new Refusal("the answer is no JSON");
  return body;
}
