sticky = {}
