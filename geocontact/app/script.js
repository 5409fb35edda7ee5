const move = (ids, value) => {
  for (const e of ids.map(id => document.getElementById(id))) if (e && e !== document.activeElement) e.value = value;
};
const send = async (input, files) => {
  const target = document.getElementById(input.dataset.target), names = [], failed = [];
  const [first, ...others] = files, many = target.tagName === 'TEXTAREA';
  if (!many) failed.push(...others.map(file => `${file.name} was not taken: one file is asked for here`));
  for (const file of many ? files : [first]) try {
    const answer = await fetch(input.dataset.to + '?name=' + encodeURIComponent(file.name), { method: 'POST', body: file });
    const said = await answer.text();
    if (answer.ok) names.push(said); else failed.push(`${file.name} was not taken: ${said}`);
  } catch (error) { failed.push(`${file.name} was not taken: ${error.message}; type the path of a folder`); }
  input.value = '';
  const row = target.closest('.field');
  const bad = row.querySelector('.failed') ?? row.appendChild(Object.assign(document.createElement('p'), { className: 'bad failed', role: 'alert' }));
  bad.textContent = failed.join('; ');
  if (!names.length) return;
  target.value = many ? [target.value, ...names].filter(Boolean).join('\n') : names[0];
  target.dispatchEvent(new Event('input', { bubbles: true }));
};
document.addEventListener('change', e => { if (e.target.matches('.pick input')) { send(e.target, e.target.files); } });
for (const kind of ['dragover', 'dragleave', 'drop']) document.addEventListener(kind, e => {
  const row = e.target.closest && e.target.closest('.field'), pick = row && row.querySelector('.pick input');
  if (kind !== 'dragleave') e.preventDefault();
  if (!pick || pick.disabled) return;
  row.classList.toggle('over', kind === 'dragover');
  if (kind === 'drop') send(pick, e.dataTransfer.files);
});
const plain = e => !(e.ctrlKey || e.metaKey || e.shiftKey || e.altKey || e.button);
const arrive = (address, title) => {
  history.pushState(null, '', (window.path_prefix || '') + address);
  document.title = title;
  scrollTo(0, 0);
  document.querySelector('h1')?.focus();
};
addEventListener('DOMContentLoaded', () => {
  const [what, then] = document.querySelectorAll('#popup span');
  what.textContent = 'The window does not answer.';
  then.textContent = 'If geocontact app was ended, start it again: results are in their folder. Else wait, this page connects again.';
});
const keep = key => {
  const here = new URL(location);
  here.search = new URLSearchParams({ filled: key });
  history.replaceState(history.state, '', here);
};
addEventListener('popstate', () => location.reload());
const ports = new WeakMap();
const attach = frame => {
  const { port1, port2 } = new MessageChannel();
  port1.onmessage = ({ data }) => store(frame, data);
  ports.set(frame, port1);
  frame.contentWindow.postMessage('geocontact', '*', [port2]);
  if (frame.marked) port1.postMessage(frame.marked);
};
const mark = (id, faces) => {
  const frame = document.getElementById(id);
  if (!frame) return;
  frame.marked = faces;
  ports.get(frame)?.postMessage(faces);
};
const store = async (frame, { name, text, landmarks }) => {
  const detail = { path: '', wrong: '', landmarks };
  try {
    const answer = await fetch(frame.dataset.to + '?name=' + encodeURIComponent(name), { method: 'POST', body: text });
    detail[answer.ok ? 'path' : 'wrong'] = await answer.text();
  } catch (error) { detail.wrong = error.message; }
  frame.dispatchEvent(new CustomEvent('landmarks', { detail }));
};
