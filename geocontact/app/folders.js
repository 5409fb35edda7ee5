{
  const everything = async reader => {
    const found = [];
    for (let some; (some = await new Promise((done, fail) => reader.readEntries(done, fail))).length;) found.push(...some);
    return found;
  };
  const files = async entry => entry.isFile
    ? [[entry.fullPath.slice(1), await new Promise((done, fail) => entry.file(done, fail))]]
    : (await Promise.all((await everything(entry.createReader())).map(files))).flat();
  const say = (row, words) => {
    const line = row.querySelector('.failed') ?? row.appendChild(Object.assign(document.createElement('p'), { className: 'bad failed', role: 'alert' }));
    line.textContent = words;
  };
  const take = async (input, name, listed) => {
    const target = document.getElementById(input.dataset.target), data = new FormData();
    try {
      for (const [path, file] of await listed) if (!file.type.startsWith('video/')) data.append(path, file);
      const answer = await fetch(`${input.dataset.to}/folder`, { method: 'POST', body: data }), said = await answer.text();
      if (!answer.ok) throw new Error(said.match(/"detail":"(.*)"/)?.[1] ?? said);
      target.value = said;
      say(target.closest('.field'), '');
      target.dispatchEvent(new Event('input', { bubbles: true }));
    } catch (error) { say(target.closest('.field'), `${name} was not taken: ${error.message}; type its path`); }
    input.value = '';
  };
  addEventListener('change', e => {
    if (!e.target.matches('input[webkitdirectory]')) return;
    e.stopPropagation();
    const chosen = [...e.target.files].map(file => [file.webkitRelativePath, file]);
    if (chosen.length) take(e.target, chosen[0][0].split('/')[0], chosen);
  }, true);
  addEventListener('drop', e => {
    const dropped = [...e.dataTransfer.items].map(item => item.webkitGetAsEntry?.()).filter(Boolean);
    if (!dropped.some(each => each.isDirectory)) return;
    e.preventDefault();
    e.stopPropagation();
    const row = e.target.closest?.('.field'), input = document.querySelector('input[webkitdirectory]');
    row?.classList.remove('over');
    const at = row ?? input?.closest('.field');
    const why = !input || input.disabled ? 'this form takes files here' : dropped.length > 1 ? 'drop one folder' : '';
    if (why && at) say(at, `${dropped.map(each => each.name).join(', ')} was not taken: ${why}`);
    else if (!why) take(input, dropped[0].name, files(dropped[0]));
  }, true);
}
