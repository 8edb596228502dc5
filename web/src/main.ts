import { mount } from 'svelte'
import App from './App.svelte'
import { useToken } from './api/client'
import './style.css'

// A server that is not on this machine's loopback gives its token in the address, once.
const hash = new URLSearchParams(location.hash.slice(1))
const token = hash.get('token') ?? sessionStorage.getItem('token')
if (token) {
  useToken(token)
  sessionStorage.setItem('token', token)
  hash.delete('token')
  history.replaceState(null, '', hash.size > 0 ? `#${hash}` : location.pathname)
}

mount(App, { target: document.getElementById('app')! })
