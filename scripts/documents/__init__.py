"""The generated parts of the READMEs: each a function from the files under results/ to Markdown."""
