"""What Sphinx is told. The sources are made by `website.stage`; notebooks come executed or not, never by Sphinx."""

from geocontact import __version__

project = "geocontact"
author = "the authors of geocontact"
project_copyright = "Apache-2.0"
version = release = __version__

extensions = ["myst_nb", "sphinx_copybutton"]
root_doc = "docs/index"
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb"}
exclude_patterns = ["**/*-result/**"]
nb_execution_mode = "off"
nb_merge_streams = True
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4  # as GitHub makes them
myst_links_external_new_tab = False
nitpicky = True

html_theme = "furo"
html_title = f"geocontact {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
pygments_style = "friendly"
