/** What a reader needs of an OpenAPI description: routes, their fields and examples, and code that calls them. */

/**
 * @typedef {object} Field
 * @property {string} name
 * @property {string} type
 * @property {string} fallback  what it is if left out; "required" if it may not be
 * @property {string} description
 */

/**
 * @typedef {object} ApiRoute
 * @property {string} id
 * @property {"GET" | "POST"} method
 * @property {string} path
 * @property {string} summary
 * @property {string} description
 * @property {Field[]} fields
 * @property {{name: string, value: any}[]} examples
 */

/** @param {any} description @returns {ApiRoute[]} */
export function routesOf(description) {
  return Object.entries(description.paths ?? {}).flatMap(([path, methods]) =>
    Object.entries(/** @type {Record<string, any>} */ (methods)).map(([method, operation]) => {
      const body = operation.requestBody?.content?.["application/json"];
      return {
        id: `${method}${path.replace(/[^a-z0-9]+/gi, "-")}`.replace(/-$/, ""),
        method: /** @type {"GET" | "POST"} */ (method.toUpperCase()),
        path,
        summary: operation.summary ?? "",
        description: operation.description ?? "",
        fields: body ? fieldsOf(body.schema, description) : [],
        examples: Object.entries(body?.examples ?? {}).map(([name, example]) => ({ name, value: /** @type {any} */ (example).value })),
      };
    }),
  );
}

/** @param {any} schema @param {any} description @returns {any} */
function resolve(schema, description) {
  const name = schema?.$ref?.split("/").at(-1);
  return name ? description.components?.schemas?.[name] : schema;
}

/** @param {any} schema @param {any} description @returns {Field[]} */
function fieldsOf(schema, description) {
  const whole = resolve(schema, description);
  const required = new Set(whole?.required ?? []);
  return Object.entries(whole?.properties ?? {}).map(([name, property]) => {
    const field = /** @type {any} */ (property);
    return {
      name,
      type: typeOf(field),
      fallback: required.has(name) ? "required" : field.default === undefined ? "" : short(JSON.stringify(field.default)),
      description: field.description ?? resolve(field, description)?.description ?? "",
    };
  });
}

/** @param {any} schema @returns {string} */
function typeOf(schema) {
  if (schema.$ref) return schema.$ref.split("/").at(-1);
  if (schema.anyOf || schema.oneOf) return [...new Set((schema.anyOf ?? schema.oneOf).map(typeOf))].join(" or ");
  if (schema.enum) return schema.enum.map((/** @type {any} */ value) => JSON.stringify(value)).join(" or ");
  if (schema.type === "array") return schema.items ? `list of ${schema.items.enum ? "names" : typeOf(schema.items)}` : "list";
  return schema.type ?? "any";
}

/** @param {string} text */
function short(text) {
  return text.length > 40 ? "all" : text;
}

/** @param {ApiRoute} route @param {string} body @param {string} origin */
export function asCurl({ method, path }, body, origin) {
  if (method === "GET") return `curl ${origin}${path}`;
  // A single quote inside a single-quoted shell word: close, escaped quote, open again.
  return `curl ${origin}${path} \\\n  -H 'Content-Type: application/json' \\\n  -d '${body.replaceAll("'", `'\\''`)}'`;
}

/** @param {ApiRoute} route @param {string} body @param {string} origin */
export function asPython({ method, path }, body, origin) {
  const call = method === "GET" ? `urlopen("${origin}${path}")` : `urlopen(Request("${origin}${path}", body, {"Content-Type": "application/json"}))`;
  const data = method === "GET" ? "" : `body = json.dumps(${pythonLiteral(body)}).encode()\n`;
  return `import json\nfrom urllib.request import Request, urlopen\n\n${data}with ${call} as answer:\n    print(json.load(answer))`;
}

/** JSON is Python but for three words. @param {string} json */
function pythonLiteral(json) {
  return json.replace(/"(?:[^"\\]|\\.)*"|\btrue\b|\bfalse\b|\bnull\b/g, (token) => ({ true: "True", false: "False", null: "None" })[token] ?? token);
}
